/* SPDX-License-Identifier: MIT
 * csgmesh view SCENE: a page for the browser that follows the scene's files. This thread waits for
 * them to change; the builder's makes models, the server's threads hand them out.
 */
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/cli.h"
#include "core/commands.h"
#include "core/options.h"
#include "core/work.h"
#include "view/view_server.h"

extern char **environ;

enum { MOST_PORT = 65535 };

static int check(cli_app *app)
{
    const cli_options *o = app->options;
    if (o->operands.count != 1)
        return cli_usage_error(app, "as csgmesh view mug.txt",
                               o->operands.count ? "one scene at a time" : "no scene given");
    if (strcmp(o->operands.items[0], "-") == 0)
        return cli_usage_error(app, "save it to a file",
                               "a scene from standard input cannot be followed");
    if (o->port > MOST_PORT)
        return cli_usage_error(app, NULL, "--port is at most %d", MOST_PORT);
    if (access(o->operands.items[0], R_OK) != 0)
        return cli_usage_error(app, "once it is shown, it may come and go", "cannot read %s: %s",
                               o->operands.items[0], strerror(errno));
    return cli_work_check(app);
}

/* The system's program that opens addresses; where there is none, or no screen, people click at
 * what was printed. */
static void open_browser(const char *url)
{
#ifdef __APPLE__
    char program[] = "open";
#else
    char program[] = "xdg-open";
    if (!getenv("DISPLAY") && !getenv("WAYLAND_DISPLAY"))
        return;
#endif
    char *arguments[] = {program, (char *)url, NULL};
    posix_spawn_file_actions_t actions;
    pid_t child;
    if (posix_spawn_file_actions_init(&actions) != 0)
        return;
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawnp(&child, program, &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
}

static bool take_files(void *user, cli_watch *watch)
{
    view_builder_watch(user, watch);
    return true;
}

static void ask(void *user)
{
    view_builder_ask(user);
}

static int show(cli_app *app, view_store *store)
{
    char url[128];
    view_builder builder;
    if (!view_builder_begin(&builder, app, store)) {
        cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot show the scene: out of memory");
        return CLI_TROUBLE;
    }
    view_server *server =
        view_server_start(app, (uint16_t)app->options->port, store, &builder, url, sizeof url);
    int status = server ? CLI_DONE : CLI_TROUBLE;
    if (server) {
        printf("%s\n", url);
        status = cli_finish_stdout(app, status);
        if (!app->options->quiet)
            cli_console_say(&app->console, CSGM_NOTE, NULL,
                            "%s is shown there and followed; Ctrl-C ends it",
                            app->options->operands.items[0]);
        if (!app->options->no_open && !app->options->roots.count)
            open_browser(url);
        cli_follow(&(cli_follower){&builder, take_files, ask});
    }
    view_store_end(store);
    view_server_stop(server);
    view_builder_end(&builder);
    return status;
}

int cli_cmd_view(cli_app *app)
{
    view_store store;
    int status = check(app);
    if (status == CLI_DONE)
        status = cli_app_open(app);
    if (status != CLI_DONE)
        return status;
    if (!view_store_begin(&store)) {
        cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot show the scene: out of memory");
        return CLI_TROUBLE;
    }
    status = show(app, &store);
    view_store_release(&store);
    return status;
}
