/* SPDX-License-Identifier: MIT
 * Roots; see roots.h.
 */
#include "core/roots.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifdef __linux__
#include <linux/landlock.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

/* What may be done below a root: all but to start programs and to make devices. */
static uint64_t allowed_rights(uint64_t handled)
{
    return handled & ~(uint64_t)(LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_MAKE_CHAR |
                                 LANDLOCK_ACCESS_FS_MAKE_BLOCK | LANDLOCK_ACCESS_FS_MAKE_SOCK);
}

/* All rights that this kernel knows, by the version of its interface. */
static uint64_t known_rights(long version)
{
    const int counts[] = {13, 14, 15}; /* versions 1 to 3: bits 0 to 12, then REFER, TRUNCATE */
    enum { COUNTS = sizeof counts / sizeof *counts };
    return ((uint64_t)1 << counts[version < COUNTS ? version - 1 : COUNTS - 1]) - 1;
}

static int refuse(cli_app *app, const char *root, int error)
{
    cli_console_say(&app->console, CSGM_ERROR, NULL, "--root %s: %s", root, strerror(error));
    return CLI_TROUBLE;
}

static int add_root(cli_app *app, int rules, uint64_t rights, const char *root)
{
    struct landlock_path_beneath_attr below = {.allowed_access = rights};
    below.parent_fd = open(root, O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (below.parent_fd < 0)
        return refuse(app, root, errno);
    long failed = syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &below, 0);
    int error = errno;
    close(below.parent_fd);
    return failed ? refuse(app, root, error) : CLI_DONE;
}

/* The folders of CSGMESH_ROOT, between colons. */
static int add_from_environment(cli_app *app, int rules, uint64_t rights, const char *text)
{
    char root[4096];
    int status = CLI_DONE;
    while (text && *text && status == CLI_DONE) {
        size_t length = strcspn(text, ":");
        if (length >= sizeof root)
            return refuse(app, "of CSGMESH_ROOT", ENAMETOOLONG);
        memcpy(root, text, length);
        root[length] = '\0';
        if (length)
            status = add_root(app, rules, rights, root);
        text += length + (text[length] != '\0');
    }
    return status;
}

static int confine(cli_app *app, int rules, uint64_t rights, const char *environment)
{
    const cli_list *roots = &app->options.roots;
    int status = add_from_environment(app, rules, rights, environment);
    for (size_t i = 0; i < roots->count && status == CLI_DONE; i++)
        status = add_root(app, rules, rights, roots->items[i]);
    if (status == CLI_DONE && (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
                               syscall(SYS_landlock_restrict_self, rules, 0) != 0))
        status = refuse(app, "cannot be enforced", errno);
    return status;
}
#endif

int cli_roots_confine(cli_app *app)
{
    const char *environment = getenv("CSGMESH_ROOT");
    if (!app->options.roots.count && (!environment || !*environment))
        return CLI_DONE;
#ifdef __linux__
    long version = syscall(SYS_landlock_create_ruleset, NULL, 0, LANDLOCK_CREATE_RULESET_VERSION);
    if (version > 0) {
        struct landlock_ruleset_attr attributes = {.handled_access_fs = known_rights(version)};
        int rules = (int)syscall(SYS_landlock_create_ruleset, &attributes, sizeof attributes, 0);
        int status = rules < 0 ? refuse(app, "cannot be enforced", errno)
                               : confine(app, rules, allowed_rights(attributes.handled_access_fs),
                                         environment);
        if (rules >= 0)
            close(rules);
        return status;
    }
#endif
    return cli_usage_error(
        app, "run it in a container that holds nothing else instead",
        "--root cannot be kept here: it needs Linux 5.13 or newer with Landlock");
}
