/* SPDX-License-Identifier: Apache-2.0 */
#include "worker/control.h"

#include "base/protocol.h"
#include "output/file.h"

#include <errno.h>
#include <jansson.h>
#include <signal.h>
#include <string.h>
#include <sys/signalfd.h>
#include <unistd.h>

enum talus_status control_open(struct control *control, struct talus_error *error)
{
    static const int wanted[] = {SIGTERM, SIGINT, SIGHUP, SIGUSR1};
    struct sigaction ignore = {.sa_handler = SIG_IGN};
    sigset_t signals;
    control->descriptor = -1;
    (void)sigemptyset(&signals);
    for (size_t index = 0; index < sizeof wanted / sizeof wanted[0]; index++)
        (void)sigaddset(&signals, wanted[index]);
    if (sigprocmask(SIG_BLOCK, &signals, NULL) != 0 || sigaction(SIGPIPE, &ignore, NULL) != 0 ||
        sigaction(SIGXFSZ, &ignore, NULL) != 0)
        return talus_error_set(error, TALUS_INTERNAL, "signals", "", "cannot set up signals: %s",
                               strerror(errno));
    control->descriptor = signalfd(-1, &signals, SFD_NONBLOCK | SFD_CLOEXEC);
    if (control->descriptor < 0)
        return talus_error_set(error, TALUS_INTERNAL, "signals", "", "cannot read signals: %s",
                               strerror(errno));
    return TALUS_OK;
}

void control_close(struct control *control)
{
    if (control->descriptor >= 0)
        (void)close(control->descriptor);
    control->descriptor = -1;
}

struct control_request control_poll(const struct control *control)
{
    struct control_request request = {.stop = false, .look = false};
    struct signalfd_siginfo signal;
    while (read(control->descriptor, &signal, sizeof signal) == (ssize_t)sizeof signal) {
        if (signal.ssi_signo == SIGUSR1)
            request.look = true;
        else
            request.stop = true;
    }
    return request;
}

/* True or false, or a count; false if it is neither. */
static bool read_wish(const json_t *value, struct control_wish *wish)
{
    json_int_t count = json_integer_value(value);
    wish->at_once = json_is_true(value);
    wish->count = count > 0 ? (uint64_t)count : 0;
    return value == NULL || json_is_boolean(value) || (json_is_integer(value) && count >= 0);
}

enum talus_status control_read(const char *folder, struct control_orders *orders,
                               struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    json_error_t mistake;
    const json_t *checkpoint = NULL, *frame = NULL;
    memset(orders, 0, sizeof *orders);
    enum talus_status status = file_path(path, folder, PROTOCOL_CONTROL_FILE, error);
    if (status != TALUS_OK)
        return status;
    if (access(path, F_OK) != 0)
        return TALUS_OK;
    json_t *root = json_load_file(path, JSON_REJECT_DUPLICATES, &mistake);
    if (root == NULL ||
        json_unpack_ex(root, &mistake, 0, "{s?F, s?o, s?o !}", "end_time", &orders->end_time,
                       "checkpoint_now", &checkpoint, "frame_now", &frame) != 0)
        status = talus_error_set(error, TALUS_INVALID, "control", "", "%s: %s",
                                 PROTOCOL_CONTROL_FILE, mistake.text);
    else if (!read_wish(checkpoint, &orders->checkpoint) || !read_wish(frame, &orders->frame))
        status = talus_error_set(error, TALUS_INVALID, "control", "",
                                 "%s: checkpoint_now and frame_now are true, false or a count",
                                 PROTOCOL_CONTROL_FILE);
    orders->end_time_given = json_object_get(root, "end_time") != NULL;
    json_decref(root);
    return status;
}
