/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/matsuoka_nakai_flow.h"

/* tan of the least dilation angle, 1 degree */
static const real least_tangent = (real)0.017455064928217585;

/* Slots with this flow, side by side: full vectors however few they are. Stresses over |s| of the
 * trial; theta is 0 in triaxial extension and 60 degrees in compression. */
struct turning_slots {
    size_t count;                 /* a multiple of MATERIAL_SLOT_MULTIPLE */
    size_t index[MATERIAL_CHUNK]; /* in the chunk; the last ones may be one and the same */
    MATERIAL_ALIGNED real friction[MATERIAL_CHUNK]; /* tan phi */
    MATERIAL_ALIGNED real dilation[MATERIAL_CHUNK]; /* tan psi */
    MATERIAL_ALIGNED real cosine[MATERIAL_CHUNK];   /* cos(3 theta_tr) */
    MATERIAL_ALIGNED real sine[MATERIAL_CHUNK];     /* sin(3 theta_tr) */
    MATERIAL_ALIGNED real beyond[MATERIAL_CHUNK];   /* (p_tr - c) / |s| */
    MATERIAL_ALIGNED real half[MATERIAL_CHUNK];     /* tan(tau / 2) */
    MATERIAL_ALIGNED real low[MATERIAL_CHUNK];      /* bracket of it */
    MATERIAL_ALIGNED real high[MATERIAL_CHUNK];
    MATERIAL_ALIGNED real live[MATERIAL_CHUNK]; /* 1 where the iteration goes on, else 0 */
};

static void collect(const struct mobilised *mobilised, size_t count, const real *yields,
                    const struct mobilised_angles *angles, const struct invariants *invariants,
                    struct turning_slots *slots)
{
    const real factor = (real)7.3484692283495345; /* 3 sqrt(6) */
    const real apex = (real)mobilised->apex;
    size_t used = 0, last = 0;
    for (size_t index = 0; index < count; index++) {
        real least = minimum(angles->tangent[index], angles->flow_tangent[index]);
        slots->index[used] = index;
        const bool turns =
            (yields[index] > 0) & (least >= least_tangent) & (invariants->norm[index] > 0);
        last = turns ? index : last;
        used += turns;
    }
    for (; used % MATERIAL_SLOT_MULTIPLE != 0; used++)
        slots->index[used] = last;
    slots->count = used;
    for (size_t place = 0; place < used; place++) {
        size_t index = slots->index[place];
        real norm = invariants->norm[index];
        real inverse = 1 / norm;
        real cosine = factor * invariants->determinant[index] * inverse * inverse * inverse;
        real sine = invariants->sine[index];
        real size = real_sqrt(cosine * cosine + sine * sine);
        slots->friction[place] = angles->tangent[index];
        slots->dilation[place] = minimum(angles->tangent[index], angles->flow_tangent[index]);
        slots->cosine[place] = cosine / size;
        slots->sine[place] = sine / size;
        slots->beyond[place] = (invariants->first[index] - apex) * inverse * (real)(1.0 / 3.0);
    }
}

struct profile { /* h(theta) = P/|s| of a surface and its derivatives */
    real value, slope, curvature;
};

/* 8 T^2 h^3 - (3 + 4 T^2) h = (9 + 8 T^2) t with T = tan(angle), t = cos(3 theta)/(3 sqrt(6)). */
TALUS_INLINE struct profile profile_of(real tangent, real cosine, real sine)
{
    const real third = (real)0.13608276348795434;     /* 1/(3 sqrt(6)) */
    const real sixth_root = (real)0.4082482904638631; /* 1/sqrt(6) */
    real square = tangent * tangent;
    real kappa = 9 + 8 * square;
    real t = third * cosine;
    real h = 1 / (3 * matsuoka_nakai_slope(matsuoka_nakai_start(tangent, 1, t)));
    real inverse = 1 / (24 * square * h * h - 3 - 4 * square);
    real slope = -kappa * sixth_root * sine * inverse;
    real curvature = -(9 * kappa * t + 48 * square * h * slope * slope) * inverse;
    return (struct profile){h, slope, curvature};
}

/* A return at a guess of tau. Where N is negative there the root is further, if there is one: at
 * most where the flow of the surface leads to N = 0, cos(tau) h_G' + sin(tau) h_G = 0, which is
 * sought instead. Without a root N is negative up to there, and the return is to the apex. */
struct turning {
    real cosine, sine; /* of tau */
    real multiplier;   /* a */
    real left;         /* N */
    real residual;     /* of the equation that is sought */
    real derivative;   /* of it by tau */
    bool far;          /* tau is less than this */
};

TALUS_INLINE struct turning turning_at(real stiffness_ratio, real friction, real dilation,
                                       real cosine, real sine, real beyond, real half)
{
    struct turning turning;
    real inverse = 1 / (1 + half * half);
    real c = (1 - half * half) * inverse;
    real s = 2 * half * inverse;
    real triple_cosine = c * (4 * c * c - 3);
    real triple_sine = s * (3 - 4 * s * s);
    real lode_cosine = cosine * triple_cosine - sine * triple_sine;
    real lode_sine = sine * triple_cosine + cosine * triple_sine;
    struct profile yield = profile_of(friction, lode_cosine, lode_sine);
    struct profile flow = profile_of(dilation, lode_cosine, lode_sine);
    real resistance = 1 / (stiffness_ratio + yield.value * flow.value);
    real a = (beyond + yield.value * c) * resistance;
    real growth = (yield.slope * c - yield.value * s -
                   a * (yield.slope * flow.value + yield.value * flow.slope)) *
                  resistance;
    turning.cosine = c;
    turning.sine = s;
    turning.multiplier = a;
    turning.left = (stiffness_ratio * c - beyond * flow.value) * resistance;
    real residual = s + a * flow.slope;
    real apex = c * flow.slope + s * flow.value;
    bool to_apex = turning.left <= 0;
    turning.residual = to_apex ? apex : residual;
    turning.derivative =
        to_apex ? c * (flow.value + flow.curvature) : c + growth * flow.slope + a * flow.curvature;
    /* past triaxial compression, past where the flow leads to the apex, or past the root */
    turning.far = (lode_sine < 0) | (apex > 0) | (residual >= 0);
    return turning;
}

TALUS_INLINE struct turning turning_of(const struct turning_slots *slots, real stiffness_ratio,
                                       size_t place)
{
    return turning_at(stiffness_ratio, slots->friction[place], slots->dilation[place],
                      slots->cosine[place], slots->sine[place], slots->beyond[place],
                      slots->half[place]);
}

/* Newton's method on all slots together, held in a bracket. */
static void iterate(real stiffness_ratio, struct turning_slots *slots)
{
    enum { STEPS_MAX = 100 };
    const real tolerance = real_sqrt(REAL_EPSILON) / 64;
    const size_t count = whole_rows(slots->count);
    for (size_t place = 0; place < count; place++) {
        slots->half[place] = slots->low[place] = 0;
        slots->high[place] = (real)0.5773502691896258; /* tan(30 degrees) */
        slots->live[place] = 1;
    }
    for (int iteration = 0; iteration < STEPS_MAX; iteration++) {
#pragma omp simd
        for (size_t place = 0; place < count; place++) {
            real half = slots->half[place];
            struct turning turning = turning_of(slots, stiffness_ratio, place);
            real low = turning.far ? slots->low[place] : half;
            real high = turning.far ? half : slots->high[place];
            real slope = turning.derivative > 0 ? turning.derivative : 1;
            real newton = half - (real)0.5 * (1 + half * half) * turning.residual / slope;
            bool inside = (turning.derivative > 0) & (newton >= low) & (newton <= high);
            real next = inside ? newton : (real)0.5 * (low + high);
            real live = slots->live[place];
            bool done = (real_absolute(next - half) <= tolerance * next) |
                        (high - low <= 2 * REAL_EPSILON * high);
            slots->half[place] = live > 0 ? next : half;
            slots->low[place] = low;
            slots->high[place] = high;
            slots->live[place] = done ? 0 : live;
        }
        if (!number_bits(count, slots->live).nonzero)
            break;
    }
}

static void write(const struct mobilised *mobilised, real stiffness_ratio,
                  const struct turning_slots *slots, struct invariants *invariants,
                  struct mobilised_flow *flow)
{
    const struct stiffness stiffness = elasticity_stiffness(&mobilised->elasticity);
    const real root = (real)2.449489742783178; /* sqrt(6) */
    const real apex = (real)mobilised->apex;
    for (size_t place = 0; place < slots->count; place++) {
        size_t index = slots->index[place];
        struct turning turning = turning_of(slots, stiffness_ratio, place);
        real norm = invariants->norm[index];
        real first = invariants->first[index];
        bool to_apex = turning.left <= 0;
        real left = to_apex ? 0 : turning.left;
        real sine = slots->sine[place];
        /* over sin(3 theta_tr), of which tau is a multiple near triaxial states */
        real across = sine > 0 ? left * turning.sine / sine : 0;
        real returned =
            to_apex
                ? apex
                : apex + 3 * norm * (slots->beyond[place] - stiffness_ratio * turning.multiplier);
        real plastic_cosine = 1 - left * turning.cosine;
        real plastic_sine = left * turning.sine;
        real plastic = real_sqrt(plastic_cosine * plastic_cosine + plastic_sine * plastic_sine);
        /* s = N (cos r - sin sqrt(6) (dev r^2 - 3 t r) / sin(3 theta_tr)), r = s_tr/|s_tr| */
        invariants->scale[index] = left * turning.cosine + across * slots->cosine[place];
        invariants->quadratic[index] = -across * root * stiffness.shear / norm;
        invariants->returned[index] = returned;
        invariants->spherical[index] = (first - returned) / (3 * stiffness.bulk);
        flow->deviatoric[index] = plastic * norm / stiffness.shear;
        flow->left[index] = left * (turning.cosine - left) * norm / (plastic > 0 ? plastic : 1);
    }
}

void matsuoka_nakai_flow(const struct mobilised *mobilised, size_t count, const real *yields,
                         const struct mobilised_angles *angles, struct invariants *invariants,
                         struct mobilised_flow *flow)
{
    const real stiffness_ratio =
        (real)(mobilised->elasticity.bulk / (2.0 * mobilised->elasticity.shear));
    struct turning_slots slots;
    for (size_t index = 0; index < count; index++)
        invariants->quadratic[index] = 0;
    collect(mobilised, count, yields, angles, invariants, &slots);
    iterate(stiffness_ratio, &slots);
    write(mobilised, stiffness_ratio, &slots, invariants, flow);
}
