/* SPDX-License-Identifier: Apache-2.0 */
/* Who makes a request, and what that lets them do. */
#ifndef TALUS_REQUEST_PRINCIPAL_H
#define TALUS_REQUEST_PRINCIPAL_H

/* Each role may do what those before it may. */
enum role { ROLE_ANYONE, ROLE_READ, ROLE_SUBMIT, ROLE_ADMIN };

struct principal {
    char name[64]; /* of the token, "" for a local user without one */
    enum role role;
};

#endif
