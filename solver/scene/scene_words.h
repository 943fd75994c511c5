/* SPDX-License-Identifier: Apache-2.0 */
/* Words of a scene for the values of its enumerations, by those values; NULL-terminated. */
#ifndef TALUS_SCENE_WORDS_H
#define TALUS_SCENE_WORDS_H

extern const char *const scene_dimension_words[]; /* enum talus_dimension */
extern const char *const scene_stress_words[];    /* enum talus_stress_update */
extern const char *const scene_strain_words[];    /* enum talus_strain */
extern const char *const scene_control_words[];   /* enum talus_anti_locking_control */
extern const char *const scene_fit_words[];       /* enum talus_anti_locking_field */
extern const char *const scene_precision_words[]; /* enum talus_precision */

#endif
