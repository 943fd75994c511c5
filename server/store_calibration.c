/* SPDX-License-Identifier: Apache-2.0 */
#include "store_calibration.h"

#include "store_internal.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static enum talus_status ratios_read(sqlite3 *database, const struct store_machine *machine,
                                     double foreign_weight, struct store_ratio *ratios,
                                     size_t capacity, size_t *count, struct talus_error *error)
{
    sqlite3_stmt *statement =
        store_prepare(database,
                      "SELECT name, build, count, weight, mean, variance, used FROM calibration"
                      " WHERE processor = ? ORDER BY used DESC LIMIT ?",
                      error);
    if (statement == NULL)
        return TALUS_IO;
    (void)sqlite3_bind_text(statement, 1, machine->processor, -1, SQLITE_STATIC);
    (void)sqlite3_bind_int64(statement, 2, (sqlite3_int64)capacity);
    int step = sqlite3_step(statement);
    for (; step == SQLITE_ROW && *count < capacity; step = sqlite3_step(statement)) {
        struct store_ratio *found = &ratios[(*count)++];
        const char *build = (const char *)sqlite3_column_text(statement, 1);
        (void)snprintf(found->name, sizeof found->name, "%s",
                       (const char *)sqlite3_column_text(statement, 0));
        found->ratio = (struct calibration_ratio){.count = sqlite3_column_int64(statement, 2),
                                                  .weight = sqlite3_column_double(statement, 3),
                                                  .mean = sqlite3_column_double(statement, 4),
                                                  .variance = sqlite3_column_double(statement, 5)};
        found->used = sqlite3_column_int64(statement, 6);
        if (build == NULL || strcmp(build, machine->build) != 0)
            found->ratio.weight = fmin(found->ratio.weight, foreign_weight);
    }
    enum talus_status status =
        step == SQLITE_DONE || step == SQLITE_ROW ? TALUS_OK : store_failure(database, error);
    store_release(statement);
    return status;
}

static enum talus_status quality_read(sqlite3 *database, struct store_quality *quality,
                                      struct talus_error *error)
{
    sqlite3_stmt *statement =
        store_prepare(database, "SELECT judged, inside, recent FROM forecast_quality", error);
    if (statement == NULL)
        return TALUS_IO;
    int step = sqlite3_step(statement);
    if (step == SQLITE_ROW)
        *quality = (struct store_quality){.judged = sqlite3_column_int64(statement, 0),
                                          .inside = sqlite3_column_int64(statement, 1),
                                          .recent = sqlite3_column_double(statement, 2)};
    enum talus_status status =
        step == SQLITE_ROW || step == SQLITE_DONE ? TALUS_OK : store_failure(database, error);
    store_release(statement);
    return status;
}

enum talus_status store_calibration_read(struct store *store, const struct store_machine *machine,
                                         double foreign_weight, struct store_ratio *ratios,
                                         size_t capacity, size_t *count,
                                         struct store_quality *quality, struct talus_error *error)
{
    *count = 0;
    *quality = (struct store_quality){0};
    (void)pthread_mutex_lock(&store->reader_mutex);
    enum talus_status status =
        ratios_read(store->reader, machine, foreign_weight, ratios, capacity, count, error);
    if (status == TALUS_OK)
        status = quality_read(store->reader, quality, error);
    (void)pthread_mutex_unlock(&store->reader_mutex);
    return status;
}

struct calibration_write {
    const struct store_machine *machine;
    const struct store_ratio *const *ratios;
    size_t count;
    const char *const *dropped;
    size_t dropped_count;
    const struct store_quality *quality;
};

static enum talus_status ratio_write(sqlite3 *database, const struct store_machine *machine,
                                     const struct store_ratio *ratio, struct talus_error *error)
{
    sqlite3_stmt *statement =
        store_prepare(database,
                      "INSERT OR REPLACE INTO calibration"
                      " (name, processor, build, count, weight, mean, variance, used)"
                      " VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
                      error);
    if (statement != NULL) {
        (void)sqlite3_bind_text(statement, 1, ratio->name, -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 2, machine->processor, -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 3, machine->build, -1, SQLITE_STATIC);
        (void)sqlite3_bind_int64(statement, 4, ratio->ratio.count);
        (void)sqlite3_bind_double(statement, 5, ratio->ratio.weight);
        (void)sqlite3_bind_double(statement, 6, ratio->ratio.mean);
        (void)sqlite3_bind_double(statement, 7, ratio->ratio.variance);
        (void)sqlite3_bind_int64(statement, 8, ratio->used);
    }
    return store_finish(database, statement, error);
}

static enum talus_status quality_write(sqlite3 *database, const struct store_quality *quality,
                                       struct talus_error *error)
{
    sqlite3_stmt *statement =
        store_prepare(database,
                      "INSERT OR REPLACE INTO forecast_quality (id, judged, inside, recent)"
                      " VALUES (1, ?, ?, ?)",
                      error);
    if (statement != NULL) {
        (void)sqlite3_bind_int64(statement, 1, quality->judged);
        (void)sqlite3_bind_int64(statement, 2, quality->inside);
        (void)sqlite3_bind_double(statement, 3, quality->recent);
    }
    return store_finish(database, statement, error);
}

static enum talus_status write_apply(sqlite3 *database, void *context, struct talus_error *error)
{
    const struct calibration_write *write = context;
    enum talus_status status = quality_write(database, write->quality, error);
    for (size_t index = 0; status == TALUS_OK && index < write->count; index++)
        status = ratio_write(database, write->machine, write->ratios[index], error);
    for (size_t index = 0; status == TALUS_OK && index < write->dropped_count; index++)
        status = store_run_for(database, "DELETE FROM calibration WHERE name = ?",
                               write->dropped[index], error);
    return status;
}

enum talus_status store_calibration_write(struct store *store, const struct store_machine *machine,
                                          const struct store_ratio *const *ratios, size_t count,
                                          const char *const *dropped, size_t dropped_count,
                                          const struct store_quality *quality,
                                          struct talus_error *error)
{
    struct calibration_write write = {machine, ratios, count, dropped, dropped_count, quality};
    return store_write(store, write_apply, &write, error);
}
