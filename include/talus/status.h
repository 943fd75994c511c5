/* SPDX-License-Identifier: Apache-2.0 */
/* What every fallible function of Talus returns, and the error that its caller owns. */
#ifndef TALUS_STATUS_H
#define TALUS_STATUS_H

enum talus_status {
    TALUS_OK = 0,
    TALUS_INVALID,     /* the input contradicts the interface */
    TALUS_UNSUPPORTED, /* promised by the interface, not in this build */
    TALUS_UNSTABLE,    /* the numbers of a run went bad (solver/health) */
    TALUS_CANCELLED,
    TALUS_MEMORY,
    TALUS_LIMIT, /* wall clock, disk or mass limit reached */
    TALUS_AUDIT, /* the run ended, but does not conserve what it must */
    TALUS_IO,
    TALUS_INTERNAL, /* should not happen: a defect of Talus */
};

/* Filled by the callee when it returns anything but TALUS_OK; the first error stays. */
struct talus_error {
    enum talus_status status;
    char code[32];     /* machine-readable: "range", "type", "required", "non_finite", ... */
    char pointer[256]; /* JSON Pointer into the scene, or "" */
    char text[1024];   /* for people: what, where, when, what to try */
};

#define TALUS_MUST_CHECK __attribute__((warn_unused_result))

/* Sets *error (which may be NULL, and is kept if it already holds an error); returns `status`. */
__attribute__((format(printf, 5, 6))) enum talus_status
talus_error_set(struct talus_error *error, enum talus_status status, const char *code,
                const char *pointer, const char *format, ...);

/* The same for memory that ran out: TALUS_MEMORY, code "memory". */
enum talus_status talus_error_memory(struct talus_error *error);

/* Short English name of a status: "ok", "invalid", ... (static storage). */
const char *talus_status_name(enum talus_status status);

#endif
