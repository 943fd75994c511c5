/* SPDX-License-Identifier: Apache-2.0 */
/* The flow of matsuoka_nakai with its own potential against the potential as its equation stands:
 * the plastic strain is normal to the surface of the dilation angle through the stress returned,
 * whose shift is found by bisection; at the apex it lies in the cone of all those normals. */
#include "material_fixture.h"

#include "math/eigen.h"

enum { SLOTS = 20480 };
static const double degrees = 180.0 / M_PI;
static const double bulk = 8e6, shear = 3.7e6;

/* 6 (kappa I3 - I1 I2) of s - c 1. */
static double surface(double kappa, double shift, const double s[3])
{
    double a = s[0] - shift;
    double b = s[1] - shift;
    double c = s[2] - shift;
    return 6.0 * (kappa * a * b * c - (a + b + c) * (a * b + b * c + c * a));
}

/* The shift, beyond every principal stress, at which the surface passes through s. */
static double find_shift(double kappa, const double s[3])
{
    double low = fmax(s[0], fmax(s[1], s[2]));
    double size = fabs(s[0] - s[1]) + fabs(s[1] - s[2]);
    double high = low + size;
    while (surface(kappa, high, s) > 0.0)
        high += high - low;
    for (int iteration = 0; iteration < 200; iteration++) {
        double middle = 0.5 * (low + high);
        if (surface(kappa, middle, s) > 0.0)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

/* Mast 2013, eq. 3.125: the derivative of the surface, to unit length. */
static void find_normal(double kappa, double shift, const double s[3], double normal[3])
{
    double a[3] = {s[0] - shift, s[1] - shift, s[2] - shift};
    double first = a[0] + a[1] + a[2];
    double second = a[0] * a[1] + a[1] * a[2] + a[2] * a[0];
    double square = 0.0;
    for (int k = 0; k < 3; k++) {
        normal[k] = kappa * a[(k + 1) % 3] * a[(k + 2) % 3] - second - first * (first - a[k]);
        square += normal[k] * normal[k];
    }
    for (int k = 0; k < 3; k++)
        normal[k] /= sqrt(square);
}

enum { DIRECTIONS = 720 };
struct potential {
    double kappa;
    double d[DIRECTIONS][3]; /* unit deviators around the hydrostatic axis */
    double h[DIRECTIONS];    /* P/|s| of the surface along them */
};

static void init_potential(struct potential *potential, double angle_deg)
{
    double tangent = tan(angle_deg / degrees);
    potential->kappa = 9.0 + 8.0 * tangent * tangent;
    for (int step = 0; step < DIRECTIONS; step++) {
        double *d = potential->d[step];
        for (int k = 0; k < 3; k++)
            d[k] = sqrt(2.0 / 3.0) * cos(2.0 * M_PI * ((double)step / DIRECTIONS + k / 3.0));
        potential->h[step] = find_shift(potential->kappa, d);
    }
}

/* How far a plastic strain is outside the cone of all normals of the potential: the largest
 * dev : d - trace h(d). */
static double beyond_normals(const struct potential *potential, const double plastic[3])
{
    double trace = plastic[0] + plastic[1] + plastic[2];
    double most = -INFINITY;
    for (int step = 0; step < DIRECTIONS; step++) {
        const double *d = potential->d[step];
        double along = d[0] * plastic[0] + d[1] * plastic[1] + d[2] * plastic[2];
        most = fmax(most, along - trace * potential->h[step]);
    }
    return most;
}

struct counts {
    size_t line, apex, turned;
};

/* The diagonal of a tensor in given axes; returns the size of the rest. */
static double diagonal_in(const struct mat3 *axes, struct sym3 tensor, double diagonal[3])
{
    struct mat3 transposed;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            transposed.m[i][j] = axes->m[j][i];
    }
    struct sym3 turned = sym3_push_forward(transposed, tensor);
    diagonal[0] = turned.xx;
    diagonal[1] = turned.yy;
    diagonal[2] = turned.zz;
    return fabs(turned.xy) + fabs(turned.yz) + fabs(turned.xz);
}

static void check_slot(struct sym3 trial, struct sym3 elastic, struct sym3 stress,
                       const struct potential *potential, double apex, struct counts *counts)
{
    struct mat3 axes;
    double s[3], plastic[3], normal[3];
    double scale = sym3_norm(trial);
    struct sym3 difference = sym3_add_scaled(trial, -1.0, elastic);
    struct sym3 deviator = sym3_deviator(stress);
    double size = sym3_norm(difference);
    sym3_eigen(trial, s, &axes);
    assert_true(diagonal_in(&axes, stress, s) < 1e-11 * scale * bulk); /* coaxial */
    assert_true(diagonal_in(&axes, difference, plastic) < 1e-11 * scale);
    if (size < 1e-6 * scale)
        return; /* round-off decides on the direction */
    if (sym3_norm(deviator) == 0.0) {
        assert_true(fabs(s[0] - apex) < 1e-11 * scale * bulk);
        assert_true(beyond_normals(potential, plastic) < 1e-9 * size);
        counts->apex++;
        return;
    }
    if (sym3_norm(deviator) < 1e-5 * scale * shear)
        return; /* too close to the apex for a normal */
    find_normal(potential->kappa, find_shift(potential->kappa, s), s, normal);
    double miss = 0.0;
    for (int k = 0; k < 3; k++)
        miss = fmax(miss, fabs(plastic[k] / size - normal[k]));
    if (miss > 1e-8)
        fail_msg("the plastic strain is %.3g off the normal", miss);
    struct sym3 start = sym3_deviator(trial);
    double cosine = sym3_dot(deviator, start) / (sym3_norm(start) * sym3_norm(deviator));
    counts->turned += cosine < 1.0 - 1e-6;
    counts->line++;
}

static void test_flow_is_normal_to_the_potential(void **context)
{
    (void)context;
    static const struct {
        double friction, dilation, cohesion;
    } cases[] = {{30, 5, 0},  {35, 35, 500}, {45, 20, 1e3},
                 {60, 60, 0}, {80, 60, 0},   {25, 1.0001, 0}};
    uint64_t state = 17;
    for (size_t index = 0; index < LENGTH(cases); index++) {
        const struct setting settings[] = {{"density", 2000.0},
                                           {"bulk_modulus", bulk},
                                           {"shear_modulus", shear},
                                           {"friction_angle", cases[index].friction},
                                           {"potential", 1.0},
                                           {"dilation_angle", cases[index].dilation},
                                           {"cohesion", cases[index].cohesion}};
        double apex = cases[index].cohesion / tan(cases[index].friction / degrees);
        struct fixture fixture;
        struct slots slots;
        struct counts counts = {0};
        struct potential potential;
        init_potential(&potential, cases[index].dilation);
        struct sym3 *trial = calloc(SLOTS, sizeof *trial);
        assert_non_null(trial);
        fixture_init(&fixture, "matsuoka_nakai", settings, LENGTH(settings));
        slots_init(&slots, SLOTS, SYM3_COMPONENTS);
        for (size_t slot = 0; slot < SLOTS; slot++) {
            double size = 1e-3 * pow(10.0, 1.5 * random_value(&state));
            trial[slot] =
                (struct sym3){random_value(&state), random_value(&state), random_value(&state),
                              random_value(&state), random_value(&state), random_value(&state)};
            trial[slot] =
                sym3_scale(size, sym3_add_diagonal(trial[slot], 2.0 * random_value(&state) - 0.5));
            slots_set(slots.batch.strain, slot, trial[slot]);
        }
        fixture.material->update_stress(fixture.constants, &slots.batch);
        for (size_t slot = 0; slot < SLOTS; slot++) {
            if (slots.batch.plastic_strain[slot] > 0.0)
                check_slot(trial[slot], slots_get(slots.batch.strain, slot),
                           slots_get(slots.batch.stress, slot), &potential, apex, &counts);
        }
        print_message("phi %g, psi %g: %zu on the surface, %zu of them turned, %zu at the apex\n",
                      cases[index].friction, cases[index].dilation, counts.line, counts.turned,
                      counts.apex);
        assert_true(counts.line > 500 && counts.apex > 100);
        assert_true(counts.turned > 100 || cases[index].dilation < 10.0);
        free(trial);
        slots_release(&slots);
        fixture_release(&fixture);
    }
}

/* Batches of 3 and 4 components give what one of 6 gives with zeros in the others; and slots in
 * reverse order the same bits, whoever shares a chunk with them. */
static void test_components_and_places(void **context)
{
    (void)context;
    enum { COUNT = 72 };
    static const size_t component_counts[] = {3, 4, 6};
    const struct setting settings[] = {{"density", 2000.0},      {"bulk_modulus", bulk},
                                       {"shear_modulus", shear}, {"friction_angle", 35.0},
                                       {"potential", 1.0},       {"dilation_angle", 12.0},
                                       {"cohesion", 200.0}};
    struct fixture fixture;
    fixture_init(&fixture, "matsuoka_nakai", settings, LENGTH(settings));
    for (size_t kind = 0; kind < LENGTH(component_counts); kind++) {
        const size_t components = component_counts[kind];
        struct slots few;
        struct slots all;
        uint64_t state = 5;
        slots_init(&few, COUNT, components);
        slots_init(&all, COUNT, SYM3_COMPONENTS);
        for (size_t slot = 0; slot < COUNT; slot++) {
            double size = slot % 3 == 0 ? 1e-7 : 1e-3;
            for (size_t k = 0; k < components; k++) {
                double strain = size * (random_value(&state) - (k < 3 ? 0.1 : 0.0));
                few.batch.strain[k][slot] = all.batch.strain[k][COUNT - 1 - slot] = strain;
            }
        }
        fixture.material->update_stress(fixture.constants, &few.batch);
        fixture.material->update_stress(fixture.constants, &all.batch);
        size_t flow_count = 0;
        for (size_t slot = 0; slot < COUNT; slot++) {
            flow_count += few.batch.plastic_strain[slot] > 0.0;
            for (size_t k = 0; k < SYM3_COMPONENTS; k++) {
                double value = k < components ? few.batch.stress[k][slot] : 0.0;
                double other = all.batch.stress[k][COUNT - 1 - slot];
                assert_true(components == SYM3_COMPONENTS ? value == other
                                                          : fabs(value - other) < 1e-8);
            }
        }
        assert_true(flow_count > COUNT / 3);
        slots_release(&few);
        slots_release(&all);
    }
    fixture_release(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_components_and_places),
        cmocka_unit_test(test_flow_is_normal_to_the_potential),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
