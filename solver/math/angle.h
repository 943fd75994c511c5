/* SPDX-License-Identifier: Apache-2.0 */
/* Angles are degrees in scenes and radians in equations. */
#ifndef TALUS_ANGLE_H
#define TALUS_ANGLE_H

static inline double angle_radians(double degrees)
{
    return degrees * (3.14159265358979323846 / 180.0);
}

static inline double angle_degrees(double radians)
{
    return radians * (180.0 / 3.14159265358979323846);
}

#endif
