/* SPDX-License-Identifier: Apache-2.0 */
/* Who makes a request, and what that lets them do. */
#ifndef TALUS_REQUEST_PRINCIPAL_H
#define TALUS_REQUEST_PRINCIPAL_H

#include <stdbool.h>

/* Each role may do what those before it may. */
enum role { ROLE_ANYONE, ROLE_READ, ROLE_SUBMIT, ROLE_ADMIN };

struct principal {
    char name[64]; /* of the token, "" for a local user without one */
    enum role role;
};

enum { TOKEN_DIGEST_SIZE = 32 };

/* By what the caller was recognised: the SHA-256 of the token, if one was given. */
struct token_proof {
    bool given;
    unsigned char digest[TOKEN_DIGEST_SIZE];
};

#endif
