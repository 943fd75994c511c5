/* SPDX-License-Identifier: Apache-2.0 */
#include "list_page.h"

#include "identifier.h"

bool list_page_read(struct request *request, struct list_page *page)
{
    page->limit = (size_t)request_query_number(request, "limit");
    page->before = target_query(&request->target, "cursor");
    if (page->before == NULL || identifier_valid(page->before))
        return true;
    request_query_refuse(request, "cursor", "this is no cursor of this list");
    return false;
}
