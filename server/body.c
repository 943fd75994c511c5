/* SPDX-License-Identifier: Apache-2.0 */
#include "body.h"

#include <string.h>

enum { DEPTH_MAX = 64 };

/* The first place where brackets nest deeper than allowed, or `length`. The parser of the JSON
 * library recurses, so this is checked before it sees the text. */
static size_t depth_check(const char *text, size_t length)
{
    int depth = 0;
    bool in_string = false;
    for (size_t index = 0; index < length; index++) {
        char character = text[index];
        if (in_string) {
            if (character == '\\')
                index++;
            else if (character == '"')
                in_string = false;
            continue;
        }
        if (character == '"')
            in_string = true;
        else if (character == '[' || character == '{')
            depth++;
        else if (character == ']' || character == '}')
            depth--;
        if (depth > DEPTH_MAX)
            return index;
    }
    return length;
}

static void not_json(struct request *request, int line, int column, const char *text)
{
    json_t *errors = json_pack("[{s:s, s:s, s:s, s:i, s:i}]", "pointer", "", "code", "json",
                               "detail", text, "line", line, "column", column);
    reply_problem(&request->reply, MHD_HTTP_BAD_REQUEST, "json", request->raw, errors,
                  "the body is not JSON: line %d, column %d: %s", line, column, text);
}

json_t *body_json(struct request *request)
{
    json_error_t problem;
    const char *text = request->body.data == NULL ? "" : request->body.data;
    size_t length = request->body.length;
    size_t deep = depth_check(text, length);
    if (deep < length) {
        int line = 1, column = 1;
        for (size_t index = 0; index < deep; index++) {
            column = text[index] == '\n' ? 1 : column + 1;
            line += text[index] == '\n';
        }
        not_json(request, line, column, "brackets nest too deep");
        return NULL;
    }
    const size_t flags = JSON_REJECT_DUPLICATES | JSON_DECODE_ANY;
    json_t *root = json_loadb(text, length, flags, &problem);
    /* 1e20 may be written with all its digits. */
    if (root == NULL && json_error_code(&problem) == json_error_numeric_overflow)
        root = json_loadb(text, length, flags | JSON_DECODE_INT_AS_REAL, &problem);
    if (root == NULL)
        not_json(request, problem.line, problem.column, problem.text);
    return root;
}

bool body_absent(struct request *request)
{
    if (request->body.length == 0 || strcmp(request->body.data, "{}") == 0)
        return true;
    json_t *errors = json_array();
    issue_add(errors, "", "unknown_key", NULL, NULL, "this call takes no body");
    reply_problem(&request->reply, MHD_HTTP_UNPROCESSABLE_CONTENT, "invalid", request->raw, errors,
                  "this call takes no body");
    return false;
}
