/* SPDX-License-Identifier: MIT
 * What the process may do at all, whatever a scene or a broken library makes of it; for good,
 * before any file is opened and any thread started. docs/untrusted.md.
 */
#ifndef CLI_SANDBOX_H
#define CLI_SANDBOX_H

#include "core/cli.h"

/* --root, --sandbox and --max-memory, from the options and the environment. CLI_DONE or
 * CLI_TROUBLE: this system cannot keep what is asked for; that is reported. */
int cli_confine(cli_app *app);

#endif
