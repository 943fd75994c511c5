/* SPDX-License-Identifier: Apache-2.0 */
#include "loadgen_socket.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum { SPARE_DESCRIPTORS = 32 };

static double clock_read(clockid_t clock)
{
    struct timespec now;
    (void)clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double loadgen_now(void)
{
    return clock_read(CLOCK_MONOTONIC);
}

double loadgen_date(void)
{
    return clock_read(CLOCK_REALTIME);
}

bool loadgen_reserve(size_t count)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0)
        return true;
    limit.rlim_cur = limit.rlim_max;
    if (setrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_max >= count + SPARE_DESCRIPTORS)
        return true;
    (void)fprintf(stderr,
                  "talus-loadgen: %zu connections are wanted and this system allows %llu open "
                  "files a process: raise the hard limit (ulimit -Hn, LimitNOFILE=)\n",
                  count, (unsigned long long)limit.rlim_max);
    return false;
}

int loadgen_connect(unsigned port)
{
    const struct sockaddr_in address = {.sin_family = AF_INET,
                                        .sin_port = htons((uint16_t)port),
                                        .sin_addr = {.s_addr = htonl(INADDR_LOOPBACK)}};
    const int one = 1;
    int descriptor = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (descriptor >= 0 &&
        connect(descriptor, (const struct sockaddr *)&address, sizeof address) == 0 &&
        setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one) == 0 &&
        fcntl(descriptor, F_SETFL, O_NONBLOCK) == 0)
        return descriptor;
    (void)fprintf(stderr, "talus-loadgen: cannot connect to port %u: %s\n", port, strerror(errno));
    if (descriptor >= 0)
        (void)close(descriptor);
    return -1;
}

bool loadgen_send(int descriptor, const char *data, size_t length)
{
    return send(descriptor, data, length, MSG_NOSIGNAL) == (ssize_t)length;
}
