/* SPDX-License-Identifier: Apache-2.0 */
/* Lists that come in pages: `limit` and `cursor` of the query. */
#ifndef TALUS_LIST_PAGE_H
#define TALUS_LIST_PAGE_H

#include "request.h"

enum { LIST_PAGE_LIMIT = 100, LIST_PAGE_LIMIT_MAX = 500 };

/* Two entries of the table of a query. */
#define LIST_PAGE_QUERY                                                                            \
    {.key = "limit",                                                                               \
     .kind = FIELD_INTEGER,                                                                        \
     .optional = true,                                                                             \
     .minimum = 1,                                                                                 \
     .maximum = LIST_PAGE_LIMIT_MAX,                                                               \
     .preset = LIST_PAGE_LIMIT,                                                                    \
     .meaning = "so many at most"},                                                                \
    {                                                                                              \
        .key = "cursor", .kind = FIELD_TEXT, .optional = true, .meaning = "of the page before"     \
    }

struct list_page {
    size_t limit;
    const char
        *before; /* id of the last item of the page before (borrowed), NULL: the first page */
};

/* Reads what page is asked for. False: the reply is made. */
bool list_page_read(struct request *request, struct list_page *page);

#endif
