/* SPDX-License-Identifier: Apache-2.0 */
#include "calibration.h"

#include "store_calibration.h"
#include "talus/version.h"

#include <math.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Names that are kept, most of them of methods; the one unused for longest makes room. */
enum { RATIOS_MAX = 256, NAMES_MAX = 8 };
/* Runs after which the cost of a method, and how busy the machine is, are what they are now. */
static const double cost_runs = 20.0, wall_runs = 10.0;
static const double foreign_runs = 3.0;   /* that those of another build are worth */
static const double quality_runs = 100.0; /* of the recent share */
/* Shorter runs say nothing of a method [s]. */
static const double processor_least = 0.02;

struct calibration {
    struct store *store;
    pthread_mutex_t mutex;
    char processor[128];
    struct store_ratio ratios[RATIOS_MAX];
    size_t count;
    int64_t used; /* of the last one that was used */
    struct store_quality quality;
};

/* "model name" of the first processor and the number of cores; where there is no such line, what
 * else identifies it. */
static void processor_name(char *name, size_t size)
{
    static const char *const keys[] = {"model name", "CPU part", "cpu model"};
    char line[512], model[96] = "unknown";
    FILE *stream = fopen("/proc/cpuinfo", "re");
    while (stream != NULL && fgets(line, sizeof line, stream) != NULL) {
        const char *value = strchr(line, ':');
        bool known = false;
        for (size_t index = 0; index < sizeof keys / sizeof keys[0]; index++)
            known = known || strncmp(line, keys[index], strlen(keys[index])) == 0;
        if (value == NULL || !known)
            continue;
        line[strcspn(line, "\n")] = '\0';
        (void)snprintf(model, sizeof model, "%.90s", value + 1 + strspn(value + 1, " \t"));
        break;
    }
    if (stream != NULL)
        (void)fclose(stream);
    (void)snprintf(name, size, "%s x %ld", model, sysconf(_SC_NPROCESSORS_ONLN));
}

static struct store_machine machine_of(const struct calibration *calibration)
{
    return (struct store_machine){.processor = calibration->processor, .build = talus_build()};
}

enum talus_status calibration_create(struct calibration **result, struct store *store,
                                     struct talus_error *error)
{
    struct calibration *calibration = calloc(1, sizeof *calibration);
    *result = calibration;
    if (calibration == NULL)
        return talus_error_memory(error);
    calibration->store = store;
    (void)pthread_mutex_init(&calibration->mutex, NULL);
    processor_name(calibration->processor, sizeof calibration->processor);
    const struct store_machine machine = machine_of(calibration);
    enum talus_status status =
        store_calibration_read(store, &machine, foreign_runs, calibration->ratios, RATIOS_MAX,
                               &calibration->count, &calibration->quality, error);
    if (calibration->count > 0)
        calibration->used = calibration->ratios[0].used;
    if (status == TALUS_OK)
        return TALUS_OK;
    calibration_destroy(calibration);
    *result = NULL;
    return status;
}

void calibration_destroy(struct calibration *calibration)
{
    if (calibration == NULL)
        return;
    (void)pthread_mutex_destroy(&calibration->mutex);
    free(calibration);
}

json_t *calibration_question(struct calibration *calibration, double busy)
{
    json_t *ratios = json_object();
    (void)pthread_mutex_lock(&calibration->mutex);
    for (size_t index = 0; index < calibration->count; index++) {
        const struct store_ratio *kept = &calibration->ratios[index];
        (void)json_object_set_new(
            ratios, kept->name,
            json_pack("[f, f, f]", kept->ratio.weight, kept->ratio.mean, kept->ratio.variance));
    }
    (void)pthread_mutex_unlock(&calibration->mutex);
    return json_pack("{s:o, s:{s:I, s:f}}", "ratios", ratios, "load", "cores",
                     (json_int_t)sysconf(_SC_NPROCESSORS_ONLN), "busy", busy);
}

/* The statistics of a name, made where there are none yet; then `dropped` may get the name that
 * made room. The mutex is held. */
static struct store_ratio *ratio_use(struct calibration *calibration, const char *name,
                                     char dropped[STORE_RATIO_NAME_SIZE])
{
    struct store_ratio *oldest = &calibration->ratios[0], *found = NULL;
    for (size_t index = 0; index < calibration->count && found == NULL; index++) {
        struct store_ratio *kept = &calibration->ratios[index];
        if (strcmp(kept->name, name) == 0)
            found = kept;
        else if (kept->used < oldest->used)
            oldest = kept;
    }
    if (found == NULL) {
        found = oldest;
        if (calibration->count < RATIOS_MAX)
            found = &calibration->ratios[calibration->count++];
        else
            memcpy(dropped, found->name, STORE_RATIO_NAME_SIZE);
        *found = (struct store_ratio){0};
        (void)snprintf(found->name, sizeof found->name, "%s", name);
    }
    found->used = ++calibration->used;
    return found;
}

static double number_of(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

/* Whether the wall time is in the interval. False where there is none to judge. */
static bool judge(struct calibration *calibration, const json_t *forecast, const json_t *metrics)
{
    const json_t *interval = json_object_get(forecast, "wall_seconds");
    double wall = number_of(metrics, "wall_seconds"), high = number_of(interval, "high");
    struct store_quality *quality = &calibration->quality;
    if (!json_is_number(json_object_get(metrics, "wall_seconds")) || !(high > 0.0))
        return false;
    bool inside = wall >= number_of(interval, "low") && wall <= high;
    quality->judged++;
    quality->inside += inside ? 1 : 0;
    quality->recent +=
        ((inside ? 1.0 : 0.0) - quality->recent) / fmin((double)quality->judged, quality_runs);
    return true;
}

/* Processor time that the forecast gives the steps that were taken: a sum over metrics. */
static double processor_expected(const json_t *learn, const json_t *metrics)
{
    const char *name;
    json_t *factor;
    double sum = 0.0;
    json_object_foreach(json_object_get(learn, "cpu_seconds"), name, factor)
    {
        double amount = strcmp(name, "fixed") == 0 ? 1.0 : number_of(metrics, name);
        sum += amount * json_number_value(factor);
    }
    return sum;
}

/* Wall time over processor time against that of an idle machine; where more threads ran than there
 * are cores, they took turns. */
static double wall_logarithm(const json_t *learn, const json_t *metrics, double processor,
                             const struct calibration_run *run)
{
    double cores = (double)sysconf(_SC_NPROCESSORS_ONLN);
    double crowd = fmax(1.0, (run->busy + run->threads) / cores);
    return log(number_of(metrics, "wall_seconds") / processor / number_of(learn, "wall_over_cpu") /
               crowd);
}

/* What one job changes. */
struct lesson {
    const struct store_ratio *changed[NAMES_MAX + 1];
    struct store_ratio copies[NAMES_MAX + 1];
    size_t count;
    char dropped[NAMES_MAX + 1][STORE_RATIO_NAME_SIZE];
};

static void lesson_add(struct calibration *calibration, struct lesson *lesson, const char *name,
                       double logarithm, double most)
{
    if (name == NULL || strlen(name) >= STORE_RATIO_NAME_SIZE || !isfinite(logarithm))
        return;
    struct store_ratio *ratio = ratio_use(calibration, name, lesson->dropped[lesson->count]);
    calibration_ratio_learn(&ratio->ratio, logarithm, most);
    lesson->copies[lesson->count] = *ratio;
    lesson->changed[lesson->count] = &lesson->copies[lesson->count];
    lesson->count++;
}

static void learn_times(struct calibration *calibration, struct lesson *lesson, const json_t *learn,
                        const json_t *metrics, const struct calibration_run *run)
{
    const json_t *names = json_object_get(learn, "names");
    double processor = number_of(metrics, "cpu_seconds");
    double expected = processor_expected(learn, metrics);
    if (!(processor >= processor_least) || !(expected > 0.0))
        return;
    for (size_t index = 0; index < json_array_size(names) && index < NAMES_MAX; index++)
        lesson_add(calibration, lesson, json_string_value(json_array_get(names, index)),
                   log(processor / expected), cost_runs);
    if (run->busy >= 0.0)
        lesson_add(calibration, lesson, json_string_value(json_object_get(learn, "wall_name")),
                   wall_logarithm(learn, metrics, processor, run), wall_runs);
}

void calibration_learn(struct calibration *calibration, const json_t *forecast,
                       const json_t *metrics, const struct calibration_run *run)
{
    struct talus_error error = {0};
    struct lesson *lesson = calloc(1, sizeof *lesson);
    if (lesson == NULL)
        return;
    (void)pthread_mutex_lock(&calibration->mutex);
    bool judged = judge(calibration, forecast, metrics);
    learn_times(calibration, lesson, json_object_get(forecast, "learn"), metrics, run);
    const struct store_quality quality = calibration->quality;
    const struct store_machine machine = machine_of(calibration);
    (void)pthread_mutex_unlock(&calibration->mutex);
    const char *dropped[NAMES_MAX + 1];
    size_t dropped_count = 0;
    for (size_t index = 0; index < lesson->count; index++) {
        if (lesson->dropped[index][0] != '\0')
            dropped[dropped_count++] = lesson->dropped[index];
    }
    if ((judged || lesson->count > 0) &&
        store_calibration_write(calibration->store, &machine, lesson->changed, lesson->count,
                                dropped, dropped_count, &quality, &error) != TALUS_OK)
        (void)fprintf(stderr, "talusd: calibration: %s\n", error.text);
    free(lesson);
}

void calibration_summarise(struct calibration *calibration, struct calibration_summary *summary)
{
    (void)pthread_mutex_lock(&calibration->mutex);
    const struct store_quality quality = calibration->quality;
    summary->names = (int64_t)calibration->count;
    (void)pthread_mutex_unlock(&calibration->mutex);
    summary->judged = quality.judged;
    summary->inside = quality.inside;
    summary->recent = quality.judged > 0 ? quality.recent : NAN;
}
