/* SPDX-License-Identifier: Apache-2.0 */
/* The worker protocol: the only thing that talusd and talus-worker share.
 *
 * A job's folder is the whole conversation. The daemon starts `talus-worker run scene.json --out
 * FOLDER --threads N --attempt A [--resume]` with the inherited, locked descriptor of `job.lock` in
 * the environment variable TALUS_LOCK_FD; the worker appends lines to events.ndjson:
 *
 *   {"event":"started","at":RFC3339,"attempt":1,"pid":1,"threads":1,"particles":N,"build":"...","isa":"...","duration":S,"resumed_from":step
 * or null}
 *   {"event":"progress",...,"fraction":0..1,"time":S,"step":N,"time_step":S,"particles":N,"particle_steps_per_second":R,"eta_seconds":S}
 *   {"event":"history",...,"rows":N}          rows of history.bin that are complete (columns:
 * history.json)
 *   {"event":"frame",...,"n":N,"time":S,"step":N,"particles":N,"fields":[...],"bytes":B,"sha256":"...","file":"frames/frame_000000.hdf"}
 *   {"event":"warning",...,"code":"...","pointer":"...","detail":"..."}
 *   {"event":"log",...,"level":"info","detail":"..."}
 *   {"event":"rewind",...,"row":N,"time":S,"frame":N}   after --resume: the first N rows and the
 * first N frames stand, later ones are void (0: all are)
 *   {"event":"checkpoint",...,"time":S,"step":N,"row":N,"frame":N}   counts, as in rewind
 *   {"event":"finished",...,"metrics":{...}}            the last line of a run that succeeded
 *   {"event":"failed",...,"reason":"unstable|audit|time_limit|memory_limit|disk_limit|cancelled|invalid|crashed","detail":"...","metrics":{...}}
 *
 * Every line carries "at" and "attempt". A line is written by one write(2). The worker exits with
 * the codes below. history.json: {"columns":[{"name","unit"}],"row_bytes":8*columns}; column 0 is
 * time. SIGTERM: checkpoint and stop ("failed" with reason "cancelled"). SIGUSR1: read control.json
 * {"end_time"?,"checkpoint_now"?,"frame_now"?}: end_time [s] holds from then on, for later attempts
 * too; the others are counts that grow with every order (or true: now, at every look). */
#ifndef TALUS_PROTOCOL_H
#define TALUS_PROTOCOL_H

enum protocol_exit {
    PROTOCOL_EXIT_SUCCEEDED = 0,
    PROTOCOL_EXIT_OTHER = 1,
    PROTOCOL_EXIT_INVALID = 10,
    PROTOCOL_EXIT_UNSTABLE = 11,
    PROTOCOL_EXIT_CANCELLED = 12,
    PROTOCOL_EXIT_MEMORY = 13,
    PROTOCOL_EXIT_LIMIT = 14,
    PROTOCOL_EXIT_AUDIT = 15,
};

enum protocol_message {
#define MESSAGE(ENUM, name) PROTOCOL_##ENUM,
#include "base/messages.def"
#undef MESSAGE
    PROTOCOL_MESSAGE_COUNT
};

/* JSON name of a message ("progress"), and back (PROTOCOL_MESSAGE_COUNT if unknown). */
const char *protocol_message_name(enum protocol_message message);
enum protocol_message protocol_message_find(const char *name);

#define PROTOCOL_EVENTS_FILE "events.ndjson"
#define PROTOCOL_LOCK_FILE "job.lock"
#define PROTOCOL_LOCK_ENVIRONMENT "TALUS_LOCK_FD"
#define PROTOCOL_CONTROL_FILE "control.json"
#define PROTOCOL_SCENE_FILE "scene.json"
#define PROTOCOL_HISTORY_FILE "history.bin"
#define PROTOCOL_HISTORY_COLUMNS_FILE "history.json"
#define PROTOCOL_RECEIPT_FILE "receipt.json"
#define PROTOCOL_LOG_FILE "log.txt"
#define PROTOCOL_CHECKPOINT_FILE "checkpoint.h5"

#endif
