/* SPDX-License-Identifier: Apache-2.0 */
/* What valid scenes become: values, defaults, warnings, the effective scene, its hash. */
#include "scene_fixture.h"

#include "boundaries/boundary.h"
#include "materials/material.h"
#include "shapes/shape.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define ASSERT_WITHIN(value, expected, tolerance)                                                  \
    assert_true(fabs((value) - (expected)) <= (tolerance))

static void values_arrive(void **state)
{
    (void)state;
    struct fixture_result result = fixture_read_valid(fixture_scene(BASE_PLANE));
    const struct talus_scene *scene = &result.scene;
    assert_int_equal(scene->dimension, TALUS_PLANE_STRAIN);
    assert_int_equal(scene->axis_count, 2);
    assert_int_equal(scene->grid.cell_count[0], 40);
    assert_int_equal(scene->grid.cell_count[1], 20);
    assert_int_equal(scene->grid.cell_count[2], 1);
    ASSERT_WITHIN(scene->grid.cell[2], 1.0, 0.0);
    ASSERT_WITHIN(scene->gravity[1], -9.81, 0.0);
    assert_int_equal(scene->solver.anti_locking, TALUS_CONTROL_CELL);
    const struct talus_material *soil = &scene->materials[0];
    const struct material *model = material_table[soil->model_index];
    assert_string_equal(soil->name, "soil");
    assert_string_equal(model->name, "drucker_prager_cap");
    ASSERT_WITHIN(soil->values[MATERIAL_VALUE_DENSITY], 2000.0, 0.0);
    ASSERT_WITHIN(soil->values[material_parameter_index(model, "friction_angle")], 30.0, 0.0);
    assert_true(isnan(soil->values[material_parameter_index(model, "young_modulus")]));
    ASSERT_WITHIN(soil->values[material_parameter_index(model, "dilation_angle")], 0.0, 0.0);
    assert_true(isnan(soil->values[material_parameter_index(model, "flow_ratio")]));
    const struct talus_body *heap = &scene->bodies[0];
    assert_string_equal(heap->name, "heap");
    assert_int_equal(heap->shape, TALUS_BODY_BOX);
    assert_int_equal(heap->lattice, TALUS_LATTICE_PER_CELL);
    assert_int_equal(heap->initial_stress, TALUS_INITIAL_GEOSTATIC);
    assert_int_equal(heap->k0_rule, TALUS_K0_GIVEN);
    ASSERT_WITHIN(heap->k0, 0.5, 0.0);
    assert_true(heap->clip_min[0] == -INFINITY && heap->clip_max[1] == INFINITY);
    const struct talus_boundary *floor_plane = &scene->boundaries[0];
    assert_string_equal(boundary_table[floor_plane->faces[0].condition_index]->name, "friction");
    ASSERT_WITHIN(floor_plane->faces[0].friction_coefficient, 1.0 / sqrt(3.0), 1e-12);
    assert_int_equal(scene->boundaries[1].face_count, 4);
    assert_int_equal(scene->probes[1].boundary_index, 1);
    assert_int_equal(scene->probes[1].face_index, 0);
    assert_int_equal(scene->probes[1].component, 0);
    assert_int_equal(scene->references[0].point_count, 2);
    assert_string_equal(scene->references[0].name, "runout");
    fixture_result_release(&result);
}

static void defaults_are_the_documented_ones(void **state)
{
    (void)state;
    struct fixture_result result = fixture_read_valid(fixture_scene(BASE_SOLID));
    const struct talus_scene *scene = &result.scene;
    const struct talus_solver_options *solver = &scene->solver;
    assert_string_equal(scene->title, "");
    ASSERT_WITHIN(solver->time_step, 0.0, 0.0);
    ASSERT_WITHIN(solver->courant, 0.4, 0.0);
    assert_false(solver->allow_unstable);
    assert_string_equal(shape_table[solver->shape_index]->name, "bspline2");
    assert_int_equal(solver->stress_update, TALUS_STRESS_MODIFIED_LAST);
    assert_int_equal(solver->strain, TALUS_STRAIN_FINITE);
    assert_int_equal(solver->anti_locking, TALUS_CONTROL_NONE);
    ASSERT_WITHIN(solver->pic_rate + solver->viscous_damping + solver->local_damping +
                      solver->force_ramp,
                  0.0, 0.0);
    assert_int_equal(scene->grid.outside, TALUS_OUTSIDE_ERROR);
    ASSERT_WITHIN(scene->grid.outside_mass_limit, 0.001, 0.0);
    ASSERT_WITHIN(scene->output.frames_every, 0.02, 1e-15);
    ASSERT_WITHIN(scene->output.history_every, 0.005, 1e-15);
    ASSERT_WITHIN(scene->output.checkpoint_every, 60.0, 0.0);
    assert_int_equal(scene->output.frame_fields, 1u << TALUS_FIELD_VELOCITY |
                                                     1u << TALUS_FIELD_STRESS |
                                                     1u << TALUS_FIELD_PLASTIC_STRAIN);
    assert_int_equal(scene->output.grid_fields, 0);
    ASSERT_WITHIN(scene->energy_growth_limit, 0.01, 0.0);
    assert_string_equal(scene->bodies[0].name, "body_0");
    assert_string_equal(scene->boundaries[0].name, "boundary_0");
    assert_int_equal(scene->bodies[0].initial_stress, TALUS_INITIAL_NONE);
    assert_int_equal(scene->boundaries[0].wall, TALUS_WALL_STOP);
    assert_false(scene->boundaries[0].tension_release);
    fixture_result_release(&result);
}

/* The shape of a scene with this solver; both the solver's and the effective scene's. */
static void assert_shape(const char *solver, const char *name)
{
    json_t *scene = fixture_scene(BASE_SOLID);
    assert_int_equal(json_object_set_new(scene, "solver", json_loads(solver, 0, NULL)), 0);
    struct fixture_result result = fixture_read_valid(scene);
    assert_string_equal(shape_table[result.scene.solver.shape_index]->name, name);
    const json_t *effective = json_object_get(result.effective, "solver");
    assert_string_equal(json_string_value(json_object_get(effective, "shape")), name);
    fixture_result_release(&result);
}

static void averages_bring_linear_shapes_along(void **state)
{
    (void)state;
    assert_shape("{}", "bspline2");
    assert_shape("{\"anti_locking\": {\"control\": \"none\"}}", "bspline2");
    assert_shape("{\"anti_locking\": {\"control\": \"cell\"}}", "linear");
    assert_shape("{\"anti_locking\": {\"control\": \"node\"}}", "linear");
    assert_shape("{\"anti_locking\": {\"control\": \"cell\"}, \"shape\": \"gimp\"}", "gimp");
}

static void faces_have_axes_and_sizes(void **state)
{
    (void)state;
    json_t *scene = fixture_scene(BASE_SOLID);
    fixture_change(scene, "/boundaries/-",
                   "{\"face\": {\"point\": [5, 5, 9], \"normal\": [0, 0, -2], \"size\": [3, 4]},"
                   " \"condition\": \"slip\"}");
    struct fixture_result result = fixture_read_valid(scene);
    const struct talus_boundary *first = &result.scene.boundaries[0];
    const struct talus_boundary *second = &result.scene.boundaries[1];
    /* normal y: t1 = z, t2 = y x z = x */
    ASSERT_WITHIN(first->axis_1[2], 1.0, 0.0);
    ASSERT_WITHIN(first->axis_2[0], 1.0, 0.0);
    ASSERT_WITHIN(first->size[0], 4.0, 1e-12);
    ASSERT_WITHIN(first->size[1], 6.0, 1e-12);
    ASSERT_WITHIN(first->point[0], 5.0, 1e-12);
    ASSERT_WITHIN(first->moment_about[2], 4.0, 1e-12);
    /* normal -z: z is parallel, so t1 = x, t2 = -z x x = -y */
    ASSERT_WITHIN(second->normal[2], -1.0, 0.0);
    ASSERT_WITHIN(second->axis_1[0], 1.0, 0.0);
    ASSERT_WITHIN(second->axis_2[1], -1.0, 0.0);
    ASSERT_WITHIN(second->size[1], 4.0, 0.0);
    fixture_result_release(&result);
}

static void faces_in_a_plane_are_lines(void **state)
{
    (void)state;
    json_t *scene = fixture_scene(BASE_PLANE);
    fixture_change(scene, "/boundaries/-",
                   "{\"face\": {\"min\": [0.5, 0], \"max\": [4, 0], \"normal\": [0, 1]},"
                   " \"condition\": \"slip\"}");
    struct fixture_result result = fixture_read_valid(scene);
    const struct talus_boundary *face = &result.scene.boundaries[2];
    ASSERT_WITHIN(fabs(face->axis_1[0]), 1.0, 0.0);
    ASSERT_WITHIN(face->size[0], 3.5, 1e-12);
    ASSERT_WITHIN(face->point[0], 2.25, 1e-12);
    fixture_result_release(&result);
}

static void boxes_have_faces_of_their_own(void **state)
{
    (void)state;
    json_t *scene = fixture_scene(BASE_PLANE);
    fixture_change(scene, "/boundaries/1/faces",
                   "{\"y_max\": {\"condition\": \"friction\", \"friction_coefficient\": 0.3}}");
    fixture_change(scene, "/boundaries/1/tension_release", "-5");
    fixture_change(scene, "/boundaries/1/area_rule", "\"source\"");
    struct fixture_result result = fixture_read_valid(scene);
    const struct talus_boundary *box = &result.scene.boundaries[1];
    assert_string_equal(boundary_table[box->faces[3].condition_index]->name, "friction");
    ASSERT_WITHIN(box->faces[3].friction_coefficient, 0.3, 0.0);
    assert_string_equal(boundary_table[box->faces[0].condition_index]->name, "slip");
    assert_true(box->tension_release && box->area_source_rule);
    ASSERT_WITHIN(box->tension_force, -5.0, 0.0);
    ASSERT_WITHIN(box->moment_about[0], 9.0, 0.0); /* the centre of its base */
    ASSERT_WITHIN(box->moment_about[1], 0.0, 0.0);
    fixture_result_release(&result);
}

static void boundaries_move_and_come_and_go(void **state)
{
    (void)state;
    json_t *scene = fixture_scene(BASE_PLANE);
    fixture_change(scene, "/boundaries/-",
                   "{\"plane\": {\"point\": [0, 8], \"normal\": [0, -1]},"
                   " \"condition\": \"velocity\", \"velocity\": [0, [[0, 0], [1, -2]]],"
                   " \"components\": [\"y\"], \"until\": 1.5}");
    fixture_change(scene, "/boundaries/-",
                   "{\"plane\": {\"point\": [0, 0], \"normal\": [0, 1]},"
                   " \"condition\": \"velocity\", \"velocity\": [3, 0], \"stays\": true,"
                   " \"from\": 0.5}");
    struct fixture_result result = fixture_read_valid(scene);
    const struct talus_boundary *piston = &result.scene.boundaries[2];
    assert_int_equal(piston->prescribed, 2);
    assert_int_equal(piston->velocity_tables[0].count, 0);
    assert_int_equal(piston->velocity_tables[1].count, 2);
    ASSERT_WITHIN(piston->velocity_tables[1].value[1], -2.0, 0.0);
    assert_false(piston->stays);
    assert_true(piston->timed && isinf(piston->from) && piston->from < 0);
    ASSERT_WITHIN(piston->until, 1.5, 0.0);
    const struct talus_boundary *belt = &result.scene.boundaries[3];
    assert_int_equal(belt->prescribed, 3);
    assert_true(belt->stays && belt->timed && isinf(belt->until));
    ASSERT_WITHIN(belt->velocity[0], 3.0, 0.0);
    ASSERT_WITHIN(belt->from, 0.5, 0.0);
    assert_false(result.scene.boundaries[0].timed);
    assert_int_equal(result.scene.boundaries[0].prescribed, 0);
    fixture_result_release(&result);
}

static void initial_stresses_have_many_forms(void **state)
{
    (void)state;
    static const struct {
        const char *value;
        enum talus_initial_stress kind;
        enum talus_k0 rule;
    } forms[] = {
        {"\"none\"", TALUS_INITIAL_NONE, TALUS_K0_GIVEN},
        {"\"hydrostatic\"", TALUS_INITIAL_HYDROSTATIC, TALUS_K0_GIVEN},
        {"{\"hydrostatic\": {\"surface\": 3}}", TALUS_INITIAL_HYDROSTATIC, TALUS_K0_GIVEN},
        {"{\"geostatic\": {}}", TALUS_INITIAL_GEOSTATIC, TALUS_K0_AUTO},
        {"{\"geostatic\": {\"k0\": \"jaky\"}}", TALUS_INITIAL_GEOSTATIC, TALUS_K0_JAKY},
        {"{\"geostatic\": {\"k0\": \"elastic\"}}", TALUS_INITIAL_GEOSTATIC, TALUS_K0_ELASTIC},
        {"[-1, -2, -3, 0.5, 0, 0]", TALUS_INITIAL_GIVEN, TALUS_K0_GIVEN},
    };
    for (size_t index = 0; index < sizeof forms / sizeof forms[0]; index++) {
        json_t *scene = fixture_scene(BASE_PLANE);
        fixture_change(scene, "/bodies/0/initial_stress", forms[index].value);
        struct fixture_result result = fixture_read_valid(scene);
        const struct talus_body *body = &result.scene.bodies[0];
        assert_int_equal(body->initial_stress, forms[index].kind);
        assert_int_equal(body->k0_rule, forms[index].rule);
        assert_true(isnan(body->surface) == (index != 2));
        ASSERT_WITHIN(body->stress[3], index == 6 ? 0.5 : 0.0, 0.0);
        fixture_result_release(&result);
    }
}

static void grids_are_rounded_up(void **state)
{
    (void)state;
    json_t *scene = fixture_scene(BASE_PLANE);
    fixture_change(scene, "/grid/max", "[20.1, 10]");
    struct fixture_result result = fixture_read_valid(scene);
    const json_t *max = json_object_get(json_object_get(result.effective, "grid"), "max");
    assert_int_equal(result.scene.grid.cell_count[0], 41);
    ASSERT_WITHIN(json_number_value(json_array_get(max, 0)), 20.5, 1e-12);
    fixture_result_release(&result);
    scene = fixture_scene(BASE_FLUID); /* 0.3 / 0.01 is not quite 30 */
    result = fixture_read_valid(scene);
    assert_int_equal(result.scene.grid.cell_count[0], 30);
    assert_int_equal(result.scene.grid.cell_count[1], 14);
    fixture_result_release(&result);
}

static void the_effective_scene_is_a_fixed_point(void **state)
{
    (void)state;
    for (int base = BASE_PLANE; base <= BASE_FLUID; base++) {
        json_t *scene = fixture_scene((enum fixture_base)base);
        fixture_change(
            scene, "/probes",
            "[{\"kind\": \"height\", \"along\": [0, 2], \"within\": {\"min\": [1, null]}},"
            " {\"kind\": \"energy\"},"
            " {\"kind\": \"point\", \"at\": [0, 0], \"field\": \"stress\","
            "  \"component\": \"zz\"}]");
        if (base == BASE_SOLID)
            fixture_change(scene, "/probes", "[{\"kind\": \"centre_of_mass\"}]");
        if (base == BASE_PLANE)
            fixture_change(scene, "/references", "[{\"probe\": \"probe_1\", \"value\": 2}]");
        struct fixture_result first = fixture_read_valid(scene), second;
        fixture_read(first.effective, &second);
        for (size_t index = 0; index < second.issues.count; index++)
            (void)fprintf(stderr, "%s: %s\n", second.issues.items[index].pointer,
                          second.issues.items[index].detail);
        assert_int_equal(second.status, TALUS_OK);
        assert_true(json_equal(first.effective, second.effective));
        char first_hash[65], second_hash[65];
        scene_hash(first.effective, first_hash);
        scene_hash(second.effective, second_hash);
        assert_string_equal(first_hash, second_hash);
        assert_int_equal(strlen(first_hash), 64);
        fixture_result_release(&first);
        fixture_result_release(&second);
    }
}

static void hash_of(json_t *scene, char hash[65])
{
    struct fixture_result result = fixture_read_valid(scene);
    scene_hash(result.effective, hash);
    fixture_result_release(&result);
}

static void the_hash_is_of_the_meaning(void **state)
{
    (void)state;
    char plain[65], titled[65], spelt_out[65], changed[65];
    json_t *scene = fixture_scene(BASE_PLANE);
    hash_of(scene, plain);
    scene = fixture_scene(BASE_PLANE);
    fixture_change(scene, "/title", "\"a name\"");
    hash_of(scene, titled);
    scene = fixture_scene(BASE_PLANE);
    fixture_change(scene, "/grid/cell", "[0.5, 0.5]");
    fixture_change(scene, "/duration", "2");
    fixture_change(scene, "/solver/courant", "0.4");
    hash_of(scene, spelt_out);
    scene = fixture_scene(BASE_PLANE);
    fixture_change(scene, "/duration", "2.0000000001");
    hash_of(scene, changed);
    assert_string_equal(plain, titled);
    assert_string_equal(plain, spelt_out);
    assert_string_not_equal(plain, changed);
}

/* The only warning of the changed plane scene. */
static void assert_warning(const char *pointer, const char *value, const char *where,
                           const char *code, const char *text)
{
    json_t *scene = fixture_scene(BASE_PLANE);
    fixture_change(scene, pointer, value);
    struct fixture_result result = fixture_read_valid(scene);
    assert_int_equal(result.warnings.count, 1);
    const struct scene_issue *warning = fixture_find(&result.warnings, where, code);
    assert_non_null(warning);
    assert_non_null(strstr(warning->detail, text));
    fixture_result_release(&result);
}

static void warnings_say_where(void **state)
{
    (void)state;
    assert_warning("/boundaries/0/plane/point", "[0, 0.2]", "/boundaries/0/plane", "off_grid_line",
                   "nodes at y = 0");
    assert_warning("/boundaries/0/plane/normal", "[1, 5]", "/boundaries/0/plane", "oblique",
                   "staircase");
    assert_warning("/boundaries/1/box/max", "[9.9, 6]", "/boundaries/1/box", "off_grid_line",
                   "from 8 to 10");
    assert_warning("/boundaries/1/box/max", "[8.1, 6]", "/boundaries/1/box", "thin", "thinner");
    assert_warning("/bodies/0/initial_stress/geostatic/k0", "0.2",
                   "/bodies/0/initial_stress/geostatic/k0", "k0_yield", "0.333");
    assert_warning("/references/0/curve", "[[0, 4], [3, 6]]", "/references/0/curve", "beyond_end",
                   "3 s");
    assert_warning("/bodies/-",
                   "{\"material\": \"soil\", \"box\": {\"min\": [3, 0], \"max\": [7, 2]},"
                   " \"particles_per_cell\": 2}",
                   "/bodies/1", "overlap", "25 %");
}

static enum talus_status read_text(const char *text, struct fixture_result *result)
{
    char path[] = "/tmp/talus_scene_XXXXXX";
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    assert_int_equal(write(descriptor, text, strlen(text)), (ssize_t)strlen(text));
    assert_int_equal(close(descriptor), 0);
    result->status = scene_read_file(path, &result->scene, &result->effective, &result->issues,
                                     &result->warnings);
    assert_int_equal(unlink(path), 0);
    return result->status;
}

static void files_that_are_not_json(void **state)
{
    (void)state;
    struct fixture_result result;
    assert_int_equal(read_text("{\n  \"duration\": 1,,\n}", &result), TALUS_INVALID);
    assert_int_equal(result.issues.count, 1);
    assert_string_equal(result.issues.items[0].code, "json");
    assert_non_null(strstr(result.issues.items[0].detail, "line 2"));
    fixture_result_release(&result);
    assert_int_equal(read_text("{\"duration\": 1, \"duration\": 2}", &result), TALUS_INVALID);
    assert_non_null(strstr(result.issues.items[0].detail, "duplicate"));
    fixture_result_release(&result);
    assert_int_equal(read_text("{\"duration\": 1e999}", &result), TALUS_INVALID);
    fixture_result_release(&result);
    assert_int_equal(read_text("[]", &result), TALUS_INVALID);
    assert_non_null(fixture_find(&result.issues, "", "type"));
    fixture_result_release(&result);
    result.status = scene_read_file("/nowhere/scene.json", &result.scene, &result.effective,
                                    &result.issues, &result.warnings);
    assert_non_null(fixture_find(&result.issues, "", "file"));
    fixture_result_release(&result);
}

static void tables_and_words_agree(void **state)
{
    (void)state;
    static const char *const conditions[] = {
#define BOUNDARY(symbol) #symbol,
#include "boundaries/boundaries.def"
#undef BOUNDARY
    };
    static const char *const shapes[] = {
#define SHAPE(symbol) #symbol,
#include "shapes/shapes.def"
#undef SHAPE
    };
    const size_t condition_count = sizeof conditions / sizeof conditions[0];
    assert_int_equal(boundary_count, condition_count);
    for (size_t index = 0; index < condition_count; index++)
        assert_string_equal(boundary_table[index]->name, conditions[index]);
    const size_t word_count = sizeof shapes / sizeof shapes[0];
    assert_int_equal(shape_count, word_count);
    for (size_t index = 0; index < word_count; index++)
        assert_string_equal(shape_table[index]->name, shapes[index]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_arrive),
        cmocka_unit_test(defaults_are_the_documented_ones),
        cmocka_unit_test(averages_bring_linear_shapes_along),
        cmocka_unit_test(faces_have_axes_and_sizes),
        cmocka_unit_test(faces_in_a_plane_are_lines),
        cmocka_unit_test(boxes_have_faces_of_their_own),
        cmocka_unit_test(boundaries_move_and_come_and_go),
        cmocka_unit_test(initial_stresses_have_many_forms),
        cmocka_unit_test(grids_are_rounded_up),
        cmocka_unit_test(the_effective_scene_is_a_fixed_point),
        cmocka_unit_test(the_hash_is_of_the_meaning),
        cmocka_unit_test(warnings_say_where),
        cmocka_unit_test(files_that_are_not_json),
        cmocka_unit_test(tables_and_words_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
