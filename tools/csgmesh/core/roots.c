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
#include <sys/prctl.h>
#include <sys/syscall.h>

#include "core/options.h"

/* Landlock as the kernel's interface has it for good; headers before Linux 5.13 do not. The numbers
 * are the same on all architectures but Alpha. */
#ifdef __alpha__
enum { CREATE_RULESET = 554, ADD_RULE, RESTRICT_SELF };
#else
enum { CREATE_RULESET = 444, ADD_RULE, RESTRICT_SELF };
#endif
enum { ASK_VERSION = 1, RULE_PATH_BENEATH = 1 };
enum { EXECUTE = 1 << 0, MAKE_CHAR = 1 << 6, MAKE_SOCK = 1 << 9, MAKE_BLOCK = 1 << 11 };

typedef struct path_beneath {
    uint64_t allowed_access;
    int32_t parent_fd;
} __attribute__((packed)) path_beneath;

/* What may be done below a root: all but to start programs and to make devices. */
static uint64_t allowed_rights(uint64_t handled)
{
    return handled & ~(uint64_t)(EXECUTE | MAKE_CHAR | MAKE_BLOCK | MAKE_SOCK);
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
    path_beneath below = {.allowed_access = rights};
    below.parent_fd = open(root, O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (below.parent_fd < 0)
        return refuse(app, root, errno);
    long failed = syscall(ADD_RULE, rules, RULE_PATH_BENEATH, &below, 0);
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
    const cli_list *roots = &app->options->roots;
    int status = add_from_environment(app, rules, rights, environment);
    for (size_t i = 0; i < roots->count && status == CLI_DONE; i++)
        status = add_root(app, rules, rights, roots->items[i]);
    if (status == CLI_DONE &&
        (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || syscall(RESTRICT_SELF, rules, 0) != 0))
        status = refuse(app, "cannot be enforced", errno);
    return status;
}

/* Why the kernel has no Landlock, by the error of asking for its version. */
static const char *why_not(int error)
{
    return error == EOPNOTSUPP ? "this kernel has Landlock, but it was not started with it (lsm=)"
           : error == ENOSYS   ? "this kernel has no Landlock (Linux 5.13 or newer can have it)"
           : error == EPERM    ? "Landlock is forbidden here, as by a container's seccomp filter"
                               : strerror(error);
}
#endif

int cli_roots_confine(cli_app *app)
{
    const char *environment = getenv("CSGMESH_ROOT");
    const char *reason = "it needs Linux 5.13 or newer with Landlock";
    if (!app->options->roots.count && (!environment || !*environment))
        return CLI_DONE;
#ifdef __linux__
    long version = syscall(CREATE_RULESET, NULL, 0, ASK_VERSION);
    if (version > 0) {
        const uint64_t handled = known_rights(version);
        int rules = (int)syscall(CREATE_RULESET, &handled, sizeof handled, 0);
        int status = rules < 0 ? refuse(app, "cannot be enforced", errno)
                               : confine(app, rules, allowed_rights(handled), environment);
        if (rules >= 0)
            close(rules);
        return status;
    }
    reason = why_not(version < 0 ? errno : ENOSYS);
#endif
    return cli_usage_error(app, "run it in a container that holds nothing else instead",
                           "--root cannot be kept here: %s", reason);
}
