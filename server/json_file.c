/* SPDX-License-Identifier: Apache-2.0 */
#include "json_file.h"

#include "folder.h"

#include <stdio.h>
#include <unistd.h>

json_t *json_file_load(const char *folder, const char *name)
{
    int descriptor = folder_open(folder, name);
    FILE *file = descriptor < 0 ? NULL : fdopen(descriptor, "r");
    if (file == NULL) {
        if (descriptor >= 0)
            (void)close(descriptor);
        return NULL;
    }
    json_t *root = json_loadf(file, 0, NULL);
    (void)fclose(file);
    return root;
}
