/* SPDX-License-Identifier: Apache-2.0 */
#include "access.h"
#include "address.h"
#include "config.h"
#include "service.h"
#include "talus/version.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

enum { EXIT_USAGE = 2 };
/* Descriptors for files of jobs, the store, helpers and workers. */
static const double descriptors_beside = 512;

/* Readers and jobs need descriptors; the usual soft limit is for programs that use select(). Says
 * so if the hard limit is too low for the connections that are allowed. */
static void descriptors_raise(const struct config *config)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0)
        return;
    limit.rlim_cur = limit.rlim_max;
    (void)setrlimit(RLIMIT_NOFILE, &limit);
    if ((double)limit.rlim_max < config->connections + descriptors_beside)
        (void)fprintf(stderr,
                      "talusd: warning: this system allows a process %llu open files, too few for "
                      "%.0f connections: raise the limit (LimitNOFILE= of a service, ulimit -Hn) "
                      "or lower `connections`\n",
                      (unsigned long long)limit.rlim_max, config->connections);
}

/* Answers signals until one asks to stop. */
static void signals_serve(struct service *service, const sigset_t *signals)
{
    siginfo_t information;
    for (;;) {
        int number = sigwaitinfo(signals, &information);
        if (number == SIGHUP)
            service_reload(service, information.si_uid);
        else if (number > 0)
            return;
    }
}

/* Serves until a signal asks to stop. */
static enum talus_status serve(const struct config *config, struct talus_error *error)
{
    char address[ADDRESS_TEXT_SIZE];
    struct service service;
    sigset_t signals;
    int listener = -1;
    (void)sigemptyset(&signals);
    (void)sigaddset(&signals, SIGTERM);
    (void)sigaddset(&signals, SIGINT);
    (void)sigaddset(&signals, SIGHUP);
    (void)pthread_sigmask(SIG_BLOCK, &signals, NULL);
    (void)signal(SIGPIPE, SIG_IGN);
    descriptors_raise(config);
    enum talus_status status = address_listen(config->listen, &listener, address, error);
    if (status == TALUS_OK)
        status = service_start(&service, config, listener, error);
    if (status != TALUS_OK)
        return status;
    (void)printf("talusd: listening on %s, state in %s\n", address, service.state);
    (void)fflush(stdout);
    if (!access_is_local(service.access))
        (void)fprintf(stderr, "talusd: warning: plain HTTP beyond this machine shows tokens and "
                              "results to the network; put a proxy with TLS before it\n");
    signals_serve(&service, &signals);
    service_stop(&service);
    if (strncmp(address, "unix:", 5) == 0)
        (void)unlink(address + 5);
    return TALUS_OK;
}

int main(int argument_count, char **arguments)
{
    struct config config;
    struct talus_error error = {0};
    enum talus_status status = config_read(&config, argument_count, arguments, &error);
    if (status == TALUS_OK && config.help)
        config_usage(stdout);
    else if (status == TALUS_OK && config.version)
        (void)printf("talusd %s\n", talus_build());
    else if (status == TALUS_OK)
        status = serve(&config, &error);
    config_release(&config);
    if (status == TALUS_OK)
        return 0;
    (void)fprintf(stderr, "talusd: %s\n", error.text);
    return status == TALUS_INVALID ? EXIT_USAGE : 1;
}
