/* SPDX-License-Identifier: Apache-2.0 */
/* Plain 3 x 3 tensors for the reference code: loops, and Jacobi's eigenvalues. */
#ifndef REFERENCE_TENSOR_H
#define REFERENCE_TENSOR_H

struct tensor {
    double m[3][3];
};

struct spectrum { /* a = sum of value[k] vector[k] (x) vector[k] */
    double value[3];
    double vector[3][3];
};

struct tensor tensor_unit(void);
struct tensor tensor_add(struct tensor a, double factor, struct tensor b); /* a + factor b */
struct tensor tensor_scale(struct tensor a, double factor);
struct tensor tensor_product(struct tensor a, struct tensor b);
struct tensor tensor_transpose(struct tensor a);
struct tensor tensor_inverse(struct tensor a);
struct tensor tensor_symmetric(struct tensor a);
struct tensor tensor_deviator(struct tensor a);
double tensor_trace(struct tensor a);
double tensor_determinant(struct tensor a);
double tensor_dot(struct tensor a, struct tensor b); /* a : b */

/* Eigenvalues and vectors of a symmetric tensor by cyclic Jacobi rotations. */
struct spectrum tensor_spectrum(struct tensor a);
struct tensor tensor_from_spectrum(const struct spectrum *spectrum);
struct tensor tensor_half_logarithm(struct tensor b);       /* 1/2 ln b */
struct tensor tensor_exponential_of_twice(struct tensor e); /* exp(2 e) */

#endif
