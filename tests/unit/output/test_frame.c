/* SPDX-License-Identifier: Apache-2.0 */
#include "output/frame.h"
#include "output/hdf5_file.h"
#include "scratch_folder.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* A frame whose points lie at (i, 2 i, 3 i), with an identity and a NAN among its mass. */
static struct frame make_frame(size_t count)
{
    struct frame frame = {.time = 0.1, .step = 12, .point_count = count, .array_count = 2};
    frame.positions = calloc(3 * count + 1, sizeof(double));
    frame.arrays[0] = (struct frame_array){.name = "id",
                                           .unit = "1",
                                           .components = 1,
                                           .number = FRAME_INTEGER,
                                           .values = calloc(count + 1, sizeof(double))};
    frame.arrays[1] = (struct frame_array){.name = "mass",
                                           .unit = "kg",
                                           .components = 1,
                                           .number = FRAME_REAL,
                                           .values = calloc(count + 1, sizeof(double))};
    for (size_t index = 0; index < count; index++) {
        for (size_t axis = 0; axis < 3; axis++)
            frame.positions[3 * index + axis] = (double)(index * (axis + 1));
        /* Beyond 2^24: a float would lose it. */
        frame.arrays[0].values[index] = 20000001.0 + (double)index;
        frame.arrays[1].values[index] = index == 1 ? (double)NAN : 0.5;
    }
    return frame;
}

static void read_dataset(hid_t file, const char *name, hid_t type, void *out)
{
    hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
    assert_true(dataset >= 0);
    assert_true(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out) >= 0);
    assert_true(H5Dclose(dataset) >= 0);
}

static void particles_come_back(void **state)
{
    enum { COUNT = 5 };
    char path[SCRATCH_PATH_SIZE];
    double points[3 * COUNT], mass[COUNT], time = 0.0;
    int64_t id[COUNT], offsets[COUNT + 1], step = 0;
    hid_t file = H5I_INVALID_HID;
    struct talus_error error = {.status = TALUS_OK};
    struct frame frame = make_frame(COUNT);
    scratch_path(path, *state, "frame.hdf");
    assert_int_equal(frame_write_vtkhdf(&frame, path, false, &error), TALUS_OK);
    assert_int_equal(hdf5_open(&file, path, &error), TALUS_OK);
    read_dataset(file, "VTKHDF/Points", H5T_NATIVE_DOUBLE, points);
    read_dataset(file, "VTKHDF/PointData/id", H5T_NATIVE_INT64, id);
    read_dataset(file, "VTKHDF/PointData/mass", H5T_NATIVE_DOUBLE, mass);
    read_dataset(file, "VTKHDF/Offsets", H5T_NATIVE_INT64, offsets);
    read_dataset(file, "VTKHDF/FieldData/Time", H5T_NATIVE_DOUBLE, &time);
    read_dataset(file, "VTKHDF/FieldData/Step", H5T_NATIVE_INT64, &step);
    assert_true(H5Fclose(file) >= 0);
    assert_true(points[3 * 4 + 2] == 12.0);
    assert_int_equal(id[4], 20000005);
    assert_true(isnan(mass[1]) && mass[2] == 0.5);
    assert_int_equal(offsets[COUNT], COUNT);
    assert_true(time == 0.1);
    assert_int_equal(step, 12);
    frame_release(&frame);
}

static void equal_frames_are_equal_files(void **state)
{
    enum { COUNT = 5000, SIZE = 1 << 20 };
    char path[SCRATCH_PATH_SIZE];
    char *one = malloc(SIZE), *other = malloc(SIZE);
    struct talus_error error = {.status = TALUS_OK};
    struct frame frame = make_frame(COUNT);
    assert_true(one != NULL && other != NULL);
    assert_int_equal(frame_write_vtkhdf(&frame, scratch_path(path, *state, "a"), true, &error),
                     TALUS_OK);
    size_t length = scratch_read(path, one, SIZE);
    assert_int_equal(frame_write_vtkhdf(&frame, scratch_path(path, *state, "b"), true, &error),
                     TALUS_OK);
    assert_int_equal(scratch_read(path, other, SIZE), length);
    assert_true(length > 10000);
    assert_memory_equal(one, other, length);
    frame_release(&frame);
    free(one);
    free(other);
}

/* All material may have left the scene. */
static void a_frame_may_be_empty(void **state)
{
    char path[SCRATCH_PATH_SIZE], text[4096];
    int64_t count = -1, offset = -1;
    hid_t file = H5I_INVALID_HID;
    struct talus_error error = {.status = TALUS_OK};
    struct frame frame = make_frame(0);
    assert_int_equal(frame_write_vtkhdf(&frame, scratch_path(path, *state, "a.hdf"), false, &error),
                     TALUS_OK);
    assert_int_equal(hdf5_open(&file, path, &error), TALUS_OK);
    read_dataset(file, "VTKHDF/NumberOfPoints", H5T_NATIVE_INT64, &count);
    read_dataset(file, "VTKHDF/Offsets", H5T_NATIVE_INT64, &offset);
    assert_true(H5Fclose(file) >= 0);
    assert_int_equal(count, 0);
    assert_int_equal(offset, 0);
    assert_int_equal(frame_write_vtu(&frame, scratch_path(path, *state, "a.vtu"), false, &error),
                     TALUS_OK);
    (void)scratch_read(path, text, sizeof text);
    assert_non_null(strstr(text, "NumberOfPoints=\"0\""));
    frame_release(&frame);
}

static void a_folder_that_is_not_there_is_told(void **state)
{
    char path[SCRATCH_PATH_SIZE];
    struct talus_error error = {.status = TALUS_OK};
    struct frame frame = make_frame(1);
    scratch_path(path, *state, "nowhere/frame.hdf");
    assert_int_equal(frame_write_vtkhdf(&frame, path, false, &error), TALUS_IO);
    assert_non_null(strstr(error.text, "No such file"));
    frame_release(&frame);
}

#define TEST(function)                                                                             \
    cmocka_unit_test_setup_teardown(function, scratch_folder_make, scratch_folder_remove)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(particles_come_back),
        TEST(equal_frames_are_equal_files),
        TEST(a_frame_may_be_empty),
        TEST(a_folder_that_is_not_there_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
