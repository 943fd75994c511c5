/* SPDX-License-Identifier: Apache-2.0 */
/* What faces do at one node: subspace of the normals, release, friction, stick, keep and stop. */
#include "boundaries/contact.h"
#include "simulation_fixture.h"

struct bench {
    struct wall_face faces[NODE_FACE_MAX];
    struct node_faces node;
    struct contact contact;
    double tolerance; /* of the sum of impulses, relative */
};

static void bench_init(struct bench *bench, double mass, const double velocity[3])
{
    memset(bench, 0, sizeof *bench);
    bench->tolerance = 1e-11;
    bench->contact = (struct contact){
        .faces = bench->faces, .node = &bench->node, .mass = mass, .time_step = 0.01};
    memcpy(bench->contact.free_velocity, velocity, sizeof bench->contact.free_velocity);
}

static struct wall_face *add_face(struct bench *bench, double x, double y, double z,
                                  const char *condition, double friction)
{
    const double length = sqrt(x * x + y * y + z * z);
    struct wall_face *face = &bench->faces[bench->node.count];
    *face = (struct wall_face){.condition = boundary_find(condition),
                               .friction_coefficient = friction,
                               .normal = {x / length, y / length, z / length},
                               .wall = TALUS_WALL_STOP};
    assert_non_null(face->condition);
    bench->node.face[bench->node.count] = (uint16_t)bench->node.count;
    bench->node.count++;
    return face;
}

/* Solves, and checks what always holds: the impulses are the change of momentum. */
static void solve(struct bench *bench)
{
    contact_solve(&bench->contact);
    double scale = 0;
    for (size_t axis = 0; axis < 3; axis++)
        scale += bench->contact.mass * fabs(bench->contact.free_velocity[axis]);
    for (size_t axis = 0; axis < 3; axis++) {
        double sum = 0;
        for (size_t index = 0; index < bench->node.count; index++)
            sum += bench->contact.impulse[index][axis];
        assert_close(bench->contact.mass * (bench->contact.handed_velocity[axis] -
                                            bench->contact.free_velocity[axis]),
                     sum, bench->tolerance, scale);
    }
}

static void assert_vector(const double actual[3], double x, double y, double z, double tolerance)
{
    assert_close(actual[0], x, tolerance, 1);
    assert_close(actual[1], y, tolerance, 1);
    assert_close(actual[2], z, tolerance, 1);
}

static void test_slip_takes_the_normal_only(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 2.0, (double[3]){1, -3, 0.5});
    add_face(&bench, 0, 1, 0, "slip", 0);
    solve(&bench);
    assert_vector(bench.contact.velocity, 1, 0, 0.5, 0);
    assert_vector(bench.contact.handed_velocity, 1, 0, 0.5, 0);
    assert_vector(bench.contact.impulse[0], 0, 6, 0, 1e-15);
    /* Two-sided: it holds back as well. */
    bench_init(&bench, 2.0, (double[3]){1, 3, 0.5});
    add_face(&bench, 0, 1, 0, "slip", 0);
    solve(&bench);
    assert_vector(bench.contact.impulse[0], 0, -6, 0, 1e-15);
}

static void test_edge_leaves_its_direction(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 1.0, (double[3]){-1, -2, 3});
    add_face(&bench, 1, 0, 0, "slip", 0);
    add_face(&bench, 0, 1, 0, "slip", 0);
    solve(&bench);
    assert_vector(bench.contact.velocity, 0, 0, 3, 0);
    assert_vector(bench.contact.impulse[0], 1, 0, 0, 1e-15);
    assert_vector(bench.contact.impulse[1], 0, 2, 0, 1e-15);
    /* An oblique edge: along (1, 1, 0) x (0, 0, 1), each face pushing along its own normal. */
    bench_init(&bench, 1.0, (double[3]){-1, -2, -3});
    add_face(&bench, 1, 1, 0, "slip", 0);
    add_face(&bench, 0, 1, 1, "slip", 0);
    solve(&bench);
    for (size_t face = 0; face < 2; face++) {
        double along = 0, size = 0, speed = 0;
        for (size_t axis = 0; axis < 3; axis++) {
            along += bench.contact.impulse[face][axis] * bench.faces[face].normal[axis];
            size += bench.contact.impulse[face][axis] * bench.contact.impulse[face][axis];
            speed += bench.contact.velocity[axis] * bench.faces[face].normal[axis];
        }
        assert_close(along, sqrt(size), 1e-12, 1);
        assert_close(speed, 0, 1e-15, 1);
    }
    assert_vector(bench.contact.velocity, -2.0 / 3, 2.0 / 3, -2.0 / 3, 1e-14);
}

static void test_corner_fixes(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 1.0, (double[3]){-1, -2, 3});
    add_face(&bench, 1, 0.1, 0, "slip", 0);
    add_face(&bench, 0, 1, 0.2, "slip", 0);
    add_face(&bench, 0.3, 0, 1, "slip", 0);
    solve(&bench);
    assert_vector(bench.contact.velocity, 0, 0, 0, 1e-15);
}

static void test_equal_normals_share(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 3.0, (double[3]){1, -2, 0});
    add_face(&bench, 0, 1, 0, "slip", 0);
    add_face(&bench, 0, 1, 0, "slip", 0);
    add_face(&bench, 1, 0, 0, "slip", 0);
    solve(&bench);
    assert_vector(bench.contact.velocity, 0, 0, 0, 1e-15);
    assert_vector(bench.contact.impulse[0], 0, 3, 0, 1e-3);
    assert_vector(bench.contact.impulse[1], 0, 3, 0, 1e-3);
    assert_vector(bench.contact.impulse[2], -3, 0, 0, 1e-9);
}

static void test_opposing_normals_hold_once(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 1.0, (double[3]){0.5, -2, 0});
    add_face(&bench, 0, 1, 0, "slip", 0);
    add_face(&bench, 0, -1, 0, "slip", 0);
    solve(&bench);
    assert_vector(bench.contact.velocity, 0.5, 0, 0, 1e-15);
    /* One-sided, only the one that is pushed answers. */
    bench_init(&bench, 1.0, (double[3]){0.5, -2, 0});
    add_face(&bench, 0, 1, 0, "slip", 0)->release = true;
    add_face(&bench, 0, -1, 0, "slip", 0)->release = true;
    solve(&bench);
    assert_vector(bench.contact.velocity, 0.5, 0, 0, 1e-15);
    assert_vector(bench.contact.impulse[0], 0, 2, 0, 1e-9);
    assert_vector(bench.contact.impulse[1], 0, 0, 0, 0);
}

static void test_tension_releases(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 2.0, (double[3]){1, 3, 0});
    add_face(&bench, 0, 1, 0, "friction", 0.5)->release = true;
    solve(&bench);
    assert_vector(bench.contact.velocity, 1, 3, 0, 0);
    assert_vector(bench.contact.impulse[0], 0, 0, 0, 0);
    /* A pull below the given force still holds: 2 kg x 3 m/s in 0.01 s is 600 N. */
    static const double forces[2] = {-599, -601};
    for (size_t index = 0; index < 2; index++) {
        bench_init(&bench, 2.0, (double[3]){0, 3, 0});
        struct wall_face *face = add_face(&bench, 0, 1, 0, "slip", 0);
        face->release = true;
        face->tension_force = forces[index];
        solve(&bench);
        assert_vector(bench.contact.velocity, 0, index == 0 ? 3 : 0, 0, 0);
    }
}

/* Faces 60 degrees apart: pressed towards one, the other would have to pull, so it lets go, and
 * then the first takes its own normal only. */
static void test_active_set_is_found_again_after_release(void **state)
{
    (void)state;
    struct bench bench;
    const double c = 0.5, s = sqrt(0.75);
    bench_init(&bench, 1.0, (double[3]){0.1, -1, 0});
    add_face(&bench, 0, 1, 0, "slip", 0)->release = true;
    add_face(&bench, s, -c, 0, "slip", 0)->release = true;
    solve(&bench);
    const double into_second = 0.1 * s + c; /* w . n2 > 0: it moves away from the second */
    assert_true(into_second > 0);
    assert_vector(bench.contact.velocity, 0.1, 0, 0, 1e-14);
    assert_vector(bench.contact.impulse[0], 0, 1, 0, 1e-12);
    assert_vector(bench.contact.impulse[1], 0, 0, 0, 0);
    /* Pressed into the wedge, both push. */
    bench_init(&bench, 1.0, (double[3]){-1, -1, 0});
    add_face(&bench, 0, 1, 0, "slip", 0)->release = true;
    add_face(&bench, s, -c, 0, "slip", 0)->release = true;
    solve(&bench);
    assert_vector(bench.contact.velocity, 0, 0, 0, 1e-14);
    assert_close(bench.contact.impulse[1][0], 1, 1e-10, 1);
}

static void test_friction_sticks_or_slides_exactly(void **state)
{
    (void)state;
    /* Normal impulse 2 m, so that 0.5 can hold a tangential speed of 1. */
    static const double speeds[4] = {0.4, 0.999, 1.001, 2.5};
    for (size_t index = 0; index < LENGTH(speeds); index++) {
        struct bench bench;
        const double along = speeds[index];
        bench_init(&bench, 4.0, (double[3]){0.6 * along, -2, 0.8 * along});
        add_face(&bench, 0, 1, 0, "friction", 0.5);
        solve(&bench);
        if (along < 1) {
            assert_vector(bench.contact.velocity, 0, 0, 0, 0);
            assert_vector(bench.contact.handed_velocity, 0, 0, 0, 0);
        } else {
            const double left = along - 1;
            assert_vector(bench.contact.velocity, 0.6 * left, 0, 0.8 * left, 1e-15);
            assert_vector(bench.contact.impulse[0], -0.6 * 4, 8, -0.8 * 4, 1e-14);
        }
    }
    /* No push, no friction. */
    struct bench bench;
    bench_init(&bench, 4.0, (double[3]){1, 2, 0});
    add_face(&bench, 0, 1, 0, "friction", 0.5);
    solve(&bench);
    assert_vector(bench.contact.velocity, 1, 0, 0, 0);
}

static void test_friction_in_an_edge_adds_both_faces(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 1.0, (double[3]){-1, -2, 3});
    add_face(&bench, 1, 0, 0, "friction", 0.5);
    add_face(&bench, 0, 1, 0, "friction", 0.25);
    solve(&bench);
    assert_vector(bench.contact.velocity, 0, 0, 2, 1e-15);
    assert_vector(bench.contact.impulse[0], 1, 0, -0.5, 1e-15);
    assert_vector(bench.contact.impulse[1], 0, 2, -0.5, 1e-15);
}

static void test_stick_holds_everything(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 2.0, (double[3]){1, 2, 3}); /* even when it is pulled */
    add_face(&bench, 0, 1, 0, "stick", 0);
    add_face(&bench, 1, 0, 0, "friction", 10);
    solve(&bench);
    assert_vector(bench.contact.velocity, 0, 0, 0, 0);
    assert_vector(bench.contact.impulse[0], 0, -4, -6, 1e-14);
    assert_vector(bench.contact.impulse[1], -2, 0, 0, 1e-14);
}

static void test_inside_of_a_box_is_held(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 2.0, (double[3]){1, 2, 3});
    add_face(&bench, 0, 1, 0, "slip", 0);
    struct wall_face *inside = add_face(&bench, 1, 0, 0, "stick", 0);
    memset(inside->normal, 0, sizeof inside->normal);
    inside->face_index = -1;
    solve(&bench);
    assert_vector(bench.contact.velocity, 0, 0, 0, 0);
    assert_vector(bench.contact.impulse[1], -2, -4, -6, 1e-15);
}

/* keep: only the acceleration of the step is taken, the particles keep their normal velocity, and
 * the reaction has no impact in it (Mast 2013, sec. 6.1); stop: both (derived). */
static void test_keep_against_stop(void **state)
{
    (void)state;
    struct bench bench;
    for (int keep = 0; keep < 2; keep++) {
        bench_init(&bench, 2.0, (double[3]){1, -3, 0});
        memcpy(bench.contact.acceleration_increment, (double[3]){0.1, -0.5, 0}, 3 * sizeof(double));
        add_face(&bench, 0, 1, 0, "slip", 0)->wall = keep ? TALUS_WALL_KEEP : TALUS_WALL_STOP;
        solve(&bench);
        assert_vector(bench.contact.velocity, 1, 0, 0, 1e-15);
        assert_vector(bench.contact.handed_velocity, 1, keep ? -2.5 : 0, 0, 1e-15);
        assert_vector(bench.contact.impulse[0], 0, keep ? 1 : 6, 0, 1e-15);
    }
}

static void test_hold_back(void **state)
{
    (void)state;
    struct bench bench;
    double increment[3] = {1, -2, 0.5};
    bench_init(&bench, 1.0, increment);
    add_face(&bench, 0, 1, 0, "slip", 0);
    contact_hold_back(&bench.contact, increment);
    assert_vector(increment, 1, 0, 0.5, 0);
    /* Friction holds back what it can hold: all of the tangent, or its limit of 0.8. */
    for (int strong = 0; strong < 2; strong++) {
        double pushed[3] = {1, -2, 0};
        bench_init(&bench, 1.0, pushed);
        add_face(&bench, 0, 1, 0, "friction", strong ? 0.6 : 0.4);
        contact_hold_back(&bench.contact, pushed);
        assert_vector(pushed, strong ? 0 : 0.2, 0, 0, 1e-15);
    }
    double lifted[3] = {1, 2, 0};
    bench_init(&bench, 1.0, lifted);
    add_face(&bench, 0, 1, 0, "stick", 0)->release = true;
    contact_hold_back(&bench.contact, lifted);
    assert_vector(lifted, 1, 2, 0, 0);
}

/* The impulses of the area in contact: all of it where the half cell at the wall is full, a share
 * where it is not. */
static void test_adhesion_holds_without_a_push(void **state)
{
    (void)state;
    for (int full = 0; full < 2; full++) {
        struct bench bench;
        const double mass = full ? 2000 * 0.5 * 0.1 : 2000 * 0.5 * 0.1 * 0.25;
        bench_init(&bench, mass, (double[3]){3, 0.2, 4}); /* pulled */
        bench.contact.density = 2000;
        bench.node.area[0] = 0.5;
        struct wall_face *face = add_face(&bench, 0, 1, 0, "friction", 0.7);
        face->half_cell = 0.1;
        face->adhesion = 1000;
        solve(&bench);
        /* a A dt = 5 N s, or a quarter; along (0.6, 0, 0.8). */
        const double held = full ? 5.0 : 1.25;
        assert_vector(bench.contact.velocity, 3 - 0.6 * held / mass, 0, 4 - 0.8 * held / mass,
                      1e-14);
        face->adhesion = 1e6; /* more than enough */
        solve(&bench);
        assert_vector(bench.contact.velocity, 0, 0, 0, 0);
    }
}

/* m v + k v^2 = m w - mu R with k = rho g A dt / xi = 2000 * 10 * 0.5 * 0.01 / 500 = 0.2. */
static void test_turbulence_slows_and_never_reverses(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 100, (double[3]){30, -1, 0});
    bench.contact.density = 2000;
    bench.contact.gravity = 10;
    bench.node.area[0] = 0.5;
    struct wall_face *face = add_face(&bench, 0, 1, 0, "friction", 0.2);
    face->half_cell = 0.1;
    face->turbulence = 500;
    solve(&bench);
    const double v = bench.contact.velocity[0];
    assert_close(100 * v + 0.2 * v * v, 100 * 30 - 0.2 * 100, 1e-14, 3000);
    assert_close(bench.contact.impulse[0][0], -(20 + 0.2 * v * v), 1e-12, 1);
    face->turbulence = 1e-9; /* takes nearly all, whatever the step */
    solve(&bench);
    assert_true(bench.contact.velocity[0] > 0 && bench.contact.velocity[0] < 1e-3);
    /* Below the limit of friction it stands still. */
    bench.contact.free_velocity[0] = 0.1999;
    solve(&bench);
    assert_true(bench.contact.velocity[0] == 0);
}

/* Random faces, conditions and velocities: the impulses always add up (in solve), a face that may
 * release never pulls, and nothing moves along the normal of a face that pushes. */
static void test_random_contacts(void **state)
{
    (void)state;
    static const char *const conditions[3] = {"slip", "friction", "stick"};
    uint64_t random = 77;
    size_t pushing = 0;
    for (size_t turn = 0; turn < 2000; turn++) {
        struct bench bench;
        bench_init(
            &bench, 1 + 0.5 * random_value(&random),
            (double[3]){random_value(&random), random_value(&random), random_value(&random)});
        bench.tolerance = 1e-10; /* some normals are nearly parallel */
        const size_t count = 1 + turn % 3;
        for (size_t index = 0; index < count; index++) {
            struct wall_face *face =
                add_face(&bench, random_value(&random), random_value(&random),
                         random_value(&random), conditions[(turn / 3 + index) % 3], 0.3);
            face->release = true;
        }
        solve(&bench);
        for (size_t index = 0; index < count; index++) {
            double push = 0, speed = 0;
            for (size_t axis = 0; axis < 3; axis++) {
                push += bench.contact.impulse[index][axis] * bench.faces[index].normal[axis];
                speed += bench.contact.velocity[axis] * bench.faces[index].normal[axis];
            }
            assert_true(push >= -1e-9);
            if (count == 1 && push > 1e-9)
                assert_close(speed, 0, 1e-12, 1);
            pushing += push > 1e-9;
        }
    }
    assert_true(pushing > 500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slip_takes_the_normal_only),
        cmocka_unit_test(test_edge_leaves_its_direction),
        cmocka_unit_test(test_corner_fixes),
        cmocka_unit_test(test_equal_normals_share),
        cmocka_unit_test(test_opposing_normals_hold_once),
        cmocka_unit_test(test_tension_releases),
        cmocka_unit_test(test_active_set_is_found_again_after_release),
        cmocka_unit_test(test_friction_sticks_or_slides_exactly),
        cmocka_unit_test(test_friction_in_an_edge_adds_both_faces),
        cmocka_unit_test(test_stick_holds_everything),
        cmocka_unit_test(test_inside_of_a_box_is_held),
        cmocka_unit_test(test_keep_against_stop),
        cmocka_unit_test(test_hold_back),
        cmocka_unit_test(test_adhesion_holds_without_a_push),
        cmocka_unit_test(test_turbulence_slows_and_never_reverses),
        cmocka_unit_test(test_random_contacts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
