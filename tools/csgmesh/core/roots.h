/* SPDX-License-Identifier: MIT
 * --root and CSGMESH_ROOT: from here on the process reads and writes nothing but what lies below
 * these folders, and starts no program, whatever a scene, a link or a library does. The kernel sees
 * to it (Landlock, Linux 5.13); descriptors that are open already stay. docs/untrusted.md.
 */
#ifndef CLI_ROOTS_H
#define CLI_ROOTS_H

#include "core/cli.h"

/* Before any file is opened and any thread started. CLI_DONE (also where there are no roots) or
 * CLI_TROUBLE: this system cannot do it, or a root cannot be opened; that is reported. */
int cli_roots_confine(cli_app *app);

#endif
