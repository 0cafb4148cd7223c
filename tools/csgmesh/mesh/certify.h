/* SPDX-License-Identifier: MIT
 * What --certify found, for people and as JSON.
 */
#ifndef CLI_CERTIFY_H
#define CLI_CERTIFY_H

#include "core/cli.h"

/* Some lines on standard error; nothing without --certify or with -q. */
void cli_certify_tell(cli_app *app, const csgm_certify *certify);
/* The object "certify"; nothing without --certify. */
void cli_certify_json(cli_json *json, const csgm_certify *certify);

#endif
