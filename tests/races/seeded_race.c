/* SPDX-License-Identifier: Apache-2.0 */
/* A race on purpose, in a parallel loop as the solver has them: the thread sanitizer must report it
 * ("racy"), and must know OpenMP's barriers well enough to report nothing else ("ordered"). */
#include <stdio.h>
#include <string.h>

enum { COUNT = 64, ROUNDS = 200 };

/* Every thread works on every entry, or two loops in a row on one entry each. */
static void add_everywhere(double *values, int stride)
{
#pragma omp parallel for num_threads(2) schedule(static)
    for (int index = 0; index < COUNT; index++)
        values[index % stride] += 1;
#pragma omp parallel for num_threads(2) schedule(dynamic)
    for (int index = COUNT - 1; index >= 0; index--)
        values[index % stride] += 1;
}

int main(int argument_count, char **arguments)
{
    double values[COUNT] = {0}, sum = 0;
    const int racy = argument_count > 1 && strcmp(arguments[1], "racy") == 0;
    for (int round = 0; round < ROUNDS; round++)
        add_everywhere(values, racy ? 1 : COUNT);
    for (int index = 0; index < COUNT; index++)
        sum += values[index];
    (void)printf("%g\n", sum);
    return !racy && sum != 2.0 * COUNT * ROUNDS;
}
