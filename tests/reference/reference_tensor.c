/* SPDX-License-Identifier: Apache-2.0 */
#include "reference_tensor.h"

#include <math.h>

struct tensor tensor_unit(void)
{
    return (struct tensor){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

struct tensor tensor_add(struct tensor a, double factor, struct tensor b)
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            a.m[i][j] += factor * b.m[i][j];
    }
    return a;
}

struct tensor tensor_scale(struct tensor a, double factor)
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            a.m[i][j] *= factor;
    }
    return a;
}

struct tensor tensor_product(struct tensor a, struct tensor b)
{
    struct tensor c;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            c.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
    }
    return c;
}

struct tensor tensor_transpose(struct tensor a)
{
    struct tensor t;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            t.m[i][j] = a.m[j][i];
    }
    return t;
}

struct tensor tensor_inverse(struct tensor a)
{
    const double inverse = 1.0 / tensor_determinant(a);
    struct tensor r;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const int p = (j + 1) % 3, q = (j + 2) % 3, s = (i + 1) % 3, t = (i + 2) % 3;
            r.m[i][j] = inverse * (a.m[p][s] * a.m[q][t] - a.m[p][t] * a.m[q][s]);
        }
    }
    return r;
}

struct tensor tensor_symmetric(struct tensor a)
{
    return tensor_scale(tensor_add(a, 1.0, tensor_transpose(a)), 0.5);
}

struct tensor tensor_deviator(struct tensor a)
{
    return tensor_add(a, -tensor_trace(a) / 3.0, tensor_unit());
}

double tensor_trace(struct tensor a)
{
    return a.m[0][0] + a.m[1][1] + a.m[2][2];
}

double tensor_determinant(struct tensor a)
{
    return a.m[0][0] * (a.m[1][1] * a.m[2][2] - a.m[1][2] * a.m[2][1]) -
           a.m[0][1] * (a.m[1][0] * a.m[2][2] - a.m[1][2] * a.m[2][0]) +
           a.m[0][2] * (a.m[1][0] * a.m[2][1] - a.m[1][1] * a.m[2][0]);
}

double tensor_dot(struct tensor a, struct tensor b)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            sum += a.m[i][j] * b.m[i][j];
    }
    return sum;
}

/* One rotation in the plane of rows p and q, which makes a_pq vanish. */
static void rotate(struct tensor *a, struct tensor *vectors, int p, int q)
{
    if (a->m[p][q] == 0)
        return;
    const double theta = (a->m[q][q] - a->m[p][p]) / (2.0 * a->m[p][q]);
    const double t = (theta >= 0 ? 1.0 : -1.0) / (fabs(theta) + sqrt(theta * theta + 1.0));
    const double c = 1.0 / sqrt(t * t + 1.0), s = t * c;
    struct tensor turn = tensor_unit();
    turn.m[p][p] = turn.m[q][q] = c;
    turn.m[p][q] = s;
    turn.m[q][p] = -s;
    *a = tensor_product(tensor_transpose(turn), tensor_product(*a, turn));
    a->m[p][q] = a->m[q][p] = 0;
    *vectors = tensor_product(*vectors, turn);
}

struct spectrum tensor_spectrum(struct tensor a)
{
    struct tensor vectors = tensor_unit();
    for (int sweep = 0; sweep < 20; sweep++) {
        if (a.m[0][1] == 0 && a.m[0][2] == 0 && a.m[1][2] == 0)
            break;
        rotate(&a, &vectors, 0, 1);
        rotate(&a, &vectors, 0, 2);
        rotate(&a, &vectors, 1, 2);
    }
    struct spectrum spectrum;
    for (int k = 0; k < 3; k++) {
        spectrum.value[k] = a.m[k][k];
        for (int i = 0; i < 3; i++)
            spectrum.vector[k][i] = vectors.m[i][k];
    }
    return spectrum;
}

struct tensor tensor_from_spectrum(const struct spectrum *spectrum)
{
    struct tensor a = {{{0}}};
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++)
                a.m[i][j] += spectrum->value[k] * spectrum->vector[k][i] * spectrum->vector[k][j];
        }
    }
    return a;
}

struct tensor tensor_half_logarithm(struct tensor b)
{
    struct spectrum spectrum = tensor_spectrum(b);
    for (int k = 0; k < 3; k++)
        spectrum.value[k] = 0.5 * log(spectrum.value[k]);
    return tensor_from_spectrum(&spectrum);
}

struct tensor tensor_exponential_of_twice(struct tensor e)
{
    struct spectrum spectrum = tensor_spectrum(e);
    for (int k = 0; k < 3; k++)
        spectrum.value[k] = exp(2.0 * spectrum.value[k]);
    return tensor_from_spectrum(&spectrum);
}
