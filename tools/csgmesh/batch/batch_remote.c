/* SPDX-License-Identifier: MIT
 * Jobs in a cache behind HTTP; see batch_remote.h.
 */
#include "batch/batch_remote.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "batch/batch_action.h"
#include "batch/batch_http.h"
#include "batch/batch_report.h"
#include "core/options.h"
#include "core/textfile.h"

enum { LISTS_MOST = 16 };                    /* lists of files under one key */
static const uint64_t ACTION_MOST = 1 << 22; /* bytes of an action: of about 40 000 outputs */
static const uint64_t TEXT_MOST = 1 << 24;

struct batch_remote {
    batch_run *run;
    batch_http *http;
    atomic_bool is_off;        /* it goes on without */
    atomic_bool takes_nothing; /* it may be read, not written */
};

/* ---- the server ----------------------------------------------------------------------- */

static bool is_over(void *user)
{
    const batch_remote *remote = user;
    cli_app *app = remote->run->app;
    return atomic_load(&remote->is_off) || (app->cancelled && app->cancelled(app));
}

batch_remote *batch_remote_open(batch_run *run)
{
    static const double PATIENCE_S = 10;
    const cli_options *options = run->app->options;
    const char *token = getenv("CSGMESH_CACHE_TOKEN");
    char reason[BATCH_HTTP_REASON] = "out of memory";
    batch_remote *remote = calloc(1, sizeof *remote);
    if (remote) {
        remote->run = run;
        remote->http = batch_http_open(
            &(batch_http_options){options->cache, token && *token ? token : NULL,
                                  options->given[CLI_OPTION_cache_timeout] ? options->cache_timeout
                                                                           : PATIENCE_S,
                                  is_over, remote},
            reason);
    }
    if (remote && remote->http)
        return remote;
    batch_report_warn(run, "no cache over HTTP: %s", reason);
    free(remote);
    return NULL;
}

void batch_remote_close(batch_remote *remote)
{
    if (remote)
        batch_http_close(remote->http);
    free(remote);
}

/* Once. */
static void give_up(batch_remote *remote, const char *what)
{
    if (!*what || atomic_exchange(&remote->is_off, true))
        return;
    batch_report_warn(remote->run, "going on without the cache %s: %s",
                      batch_http_shown(remote->http), what);
}

/* An answer that is none of the protocol's; 0 with the reason where there is none. */
static void give_up_answer(batch_remote *remote, long status, const char *reason)
{
    char words[32];
    snprintf(words, sizeof words, "it answers %ld", status);
    give_up(remote, status ? words : reason);
}

/* ---- reading -------------------------------------------------------------------------- */

typedef struct buffer {
    char *bytes;
    size_t count, room, most;
} buffer;

static bool take_bytes(void *user, const char *bytes, size_t count)
{
    buffer *b = user;
    if (count > b->most - b->count)
        return false;
    if (b->count + count + 1 > b->room) {
        size_t room = 2 * b->room + count + 1;
        char *larger = realloc(b->bytes, room);
        if (!larger)
            return false;
        b->bytes = larger;
        b->room = room;
    }
    memcpy(b->bytes + b->count, bytes, count);
    b->count += count;
    return true;
}

/* "/ac/" or "/cas/" and the name. */
typedef struct place {
    char text[BATCH_SHA256_TEXT + 8];
} place;

static place place_of(const char *kind, const char *sha256)
{
    place p;
    snprintf(p.text, sizeof p.text, "/%s/%s", kind, sha256);
    return p;
}

/* All of an entry of at most so many bytes, in the arena, terminated. NULL: it is not there. */
static const char *get_entry(batch_remote *remote, cli_arena *arena, const place *from,
                             uint64_t most, size_t *length)
{
    buffer b = {.most = (size_t)most};
    char reason[BATCH_HTTP_REASON];
    const char *copy = NULL;
    if (is_over(remote))
        return NULL;
    long status = batch_http_get(remote->http, from->text, most, take_bytes, &b, reason);
    *length = b.count;
    if (status == 200)
        copy = cli_arena_strndup(arena, b.bytes ? b.bytes : "", b.count);
    else if (status == 0 && !*reason && !is_over(remote))
        give_up(remote, "it answers with more than an entry can be");
    else if (status != 404)
        give_up_answer(remote, status, reason);
    free(b.bytes);
    return copy && !arena->failed ? copy : NULL;
}

static bool get_action(batch_remote *remote, cli_arena *arena, const char *name, batch_action *out)
{
    size_t length;
    place from = place_of("ac", name);
    const char *bytes = get_entry(remote, arena, &from, ACTION_MOST, &length);
    if (!bytes)
        return false;
    bool good = batch_action_parse(arena, bytes, length, out);
    if (!good && !arena->failed)
        give_up(remote, "it answers what is no result of an action");
    return good;
}

static const char WRONG_BYTES[] = "it gives bytes that do not have the digest of their name";

/* A text by its digest. */
static const char *get_text(batch_remote *remote, cli_arena *arena, const batch_blob *blob)
{
    size_t length;
    char found[BATCH_SHA256_TEXT];
    place from = place_of("cas", blob->sha256);
    const char *text =
        blob->bytes <= TEXT_MOST ? get_entry(remote, arena, &from, blob->bytes, &length) : NULL;
    if (!text)
        return NULL;
    batch_sha256_of(text, length, found);
    if (length == blob->bytes && strcmp(found, blob->sha256) == 0)
        return text;
    give_up(remote, WRONG_BYTES);
    return NULL;
}

typedef struct download {
    int fd;
    uint64_t count, most;
    batch_sha256 sha256;
    batch_hasher blake2;
    bool is_too_long, is_full; /* of the server; of the disk here */
} download;

static bool take_file(void *user, const char *bytes, size_t count)
{
    download *d = user;
    d->count += count;
    d->is_too_long = d->count > d->most;
    d->is_full = !d->is_too_long && !cli_write_fully(d->fd, bytes, count);
    if (d->is_too_long || d->is_full)
        return false;
    batch_sha256_add(&d->sha256, bytes, count);
    batch_hash_add(&d->blake2, bytes, count);
    return true;
}

static bool is_right(download *d, const batch_blob *blob, const batch_digest *digest)
{
    char found[BATCH_SHA256_TEXT];
    batch_digest blake2 = batch_hash_end(&d->blake2);
    batch_sha256_end(&d->sha256, found);
    return d->count == blob->bytes && strcmp(found, blob->sha256) == 0 &&
           batch_digest_equal(&blake2, digest);
}

/* An output: it gets its name once all of it is there and right. */
static bool get_output(batch_remote *remote, const batch_blob *blob, const batch_output *output)
{
    const cli_options *options = remote->run->app->options;
    batch_digest there;
    csgm_file *file = NULL;
    char reason[BATCH_HTTP_REASON];
    if (batch_hash_path(output->path, &there) && batch_digest_equal(&there, &output->digest))
        return true;
    if (is_over(remote) || !batch_make_folders(output->path, false) ||
        csgm_file_create(NULL, output->path, &file) != CSGM_OK)
        return false;
    download d = {.fd = csgm_file_descriptor(file), .most = blob->bytes};
    place from = place_of("cas", blob->sha256);
    batch_sha256_begin(&d.sha256);
    batch_hash_begin(&d.blake2);
    long status = batch_http_get(remote->http, from.text, blob->bytes, take_file, &d, reason);
    bool good = status == 200 && is_right(&d, blob, &output->digest);
    if (d.is_too_long || (status == 200 && !good))
        give_up(remote, WRONG_BYTES);
    else if (status != 200 && status != 404 && !d.is_full)
        give_up_answer(remote, status, reason);
    return csgm_file_end(file, good, !options->no_sync) == CSGM_OK && good;
}

/* ---- names ---------------------------------------------------------------------------- */

/* Where the lists of files are that such a scene reads. false: it cannot be read. */
static bool name_lists(batch_run *run, cli_arena *arena, const batch_job *job,
                       const batch_digest *key, char name[BATCH_SHA256_TEXT])
{
    batch_digest both;
    char text[BATCH_DIGEST_TEXT];
    if (!batch_record_scene_key(&run->memo, job, key, &both))
        return false;
    batch_digest_print(&both, text);
    const char *whole = cli_arena_printf(arena, "csgmesh batch lists 1\n%s\n", text);
    batch_sha256_of(whole, strlen(whole), name);
    return !arena->failed;
}

/* The names of the files that a record has read or missed; NULL: no memory. */
static const char *list_of(cli_arena *arena, const batch_job *job, const batch_record *record)
{
    batch_record list = {
        .key = record->key, .input_count = record->input_count, .absent = record->absent};
    list.inputs = cli_arena_alloc(arena, (record->input_count + 1) * sizeof *list.inputs);
    for (size_t i = 0; list.inputs && i < record->input_count; i++)
        list.inputs[i].path = record->inputs[i].path;
    return list.inputs ? batch_record_print(arena, job, &list) : NULL;
}

/* Where the result is of a job that reads the files of this list, with the digests that they have
 * here. false: a file is not as the list has it. */
static bool name_result(batch_run *run, cli_arena *arena, const batch_job *job, const char *text,
                        char name[BATCH_SHA256_TEXT])
{
    batch_record list;
    if (!batch_record_parse(arena, job, run->plan->directory, text, &list))
        return false;
    for (size_t i = 0; i < list.input_count; i++)
        if (!batch_memo_digest(&run->memo, list.inputs[i].path, &list.inputs[i].digest))
            return false;
    const char *filled = batch_record_print(arena, job, &list);
    const char *whole = filled ? cli_arena_printf(arena, "csgmesh batch result 1\n%s", filled) : "";
    batch_sha256_of(whole, strlen(whole), name);
    return !arena->failed && batch_record_inputs_hold(&run->memo, &list);
}

/* ---- taking --------------------------------------------------------------------------- */

/* The record of a result, and its outputs. */
static bool take_result(batch_run *run, cli_arena *arena, const batch_job *job,
                        const batch_digest *key, const char *name, batch_record *record)
{
    batch_action action;
    if (!get_action(run->remote, arena, name, &action))
        return false;
    const char *text = get_text(run->remote, arena, &action.files[0]);
    if (!text || !batch_record_is_taken(run, arena, job, key, text, record) ||
        action.count != record->output_count + 1)
        return false;
    for (size_t i = 0; i < record->output_count; i++)
        if (!get_output(run->remote, &action.files[i + 1], &record->outputs[i]) ||
            !batch_output_look(&record->outputs[i]))
            return false;
    return true;
}

/* The text of the lists; NULL: there are none. */
static const char *get_lists(batch_remote *remote, cli_arena *arena, const char *name)
{
    batch_action action;
    return get_action(remote, arena, name, &action) ? get_text(remote, arena, &action.files[0])
                                                    : NULL;
}

static const char END[] = "\nend\n";

/* Behind the list that the text begins with; NULL: it is not whole. */
static const char *next_list(const char *text)
{
    const char *end = strstr(text, END);
    return end ? end + sizeof END - 1 : NULL;
}

bool batch_remote_take(batch_run *run, cli_arena *arena, const batch_job *job,
                       const batch_digest *key, batch_record *record)
{
    char name[BATCH_SHA256_TEXT];
    if (is_over(run->remote) || !name_lists(run, arena, job, key, name))
        return false;
    const char *text = get_lists(run->remote, arena, name);
    for (int i = 0; text && *text && i < LISTS_MOST; i++, text = next_list(text))
        if (name_result(run, arena, job, text, name) &&
            take_result(run, arena, job, key, name, record))
            return true;
    return false;
}

/* ---- storing -------------------------------------------------------------------------- */

/* A server that may be read and not written is a cache all the same. */
static bool check_put(batch_remote *remote, long status, const char *reason)
{
    if (status >= 200 && status < 300)
        return true;
    bool refuses = (status >= 400 && status < 500) || status == 501 || status == 507;
    if (!refuses)
        give_up_answer(remote, status, reason);
    else if (!atomic_exchange(&remote->takes_nothing, true))
        batch_report_warn(remote->run, "the cache %s takes nothing from here: it answers %ld",
                          batch_http_shown(remote->http), status);
    return false;
}

static bool put_entry(batch_remote *remote, const place *to, const char *bytes, int fd,
                      uint64_t count)
{
    char reason[BATCH_HTTP_REASON];
    if (is_over(remote) || atomic_load(&remote->takes_nothing))
        return false;
    long status = batch_http_put(remote->http, to->text, bytes, fd, count, reason);
    return check_put(remote, status, reason);
}

static bool put_text(batch_remote *remote, const char *text, batch_blob *out)
{
    out->bytes = strlen(text);
    batch_sha256_of(text, strlen(text), out->sha256);
    place to = place_of("cas", out->sha256);
    return put_entry(remote, &to, text, -1, out->bytes);
}

static bool put_action(batch_remote *remote, cli_arena *arena, const char *name,
                       const batch_action *action)
{
    size_t length;
    place to = place_of("ac", name);
    const char *bytes = batch_action_print(arena, action, &length);
    return bytes && put_entry(remote, &to, bytes, -1, length);
}

/* false: it cannot be read, or is not what the record says. */
static bool hash_file(int fd, const batch_output *output, batch_blob *out)
{
    char bytes[1 << 16];
    batch_sha256 sha256;
    batch_hasher blake2;
    ssize_t count;
    batch_sha256_begin(&sha256);
    batch_hash_begin(&blake2);
    for (out->bytes = 0; (count = read(fd, bytes, sizeof bytes)) != 0;) {
        if (count < 0 && errno == EINTR)
            continue;
        if (count < 0)
            return false;
        batch_sha256_add(&sha256, bytes, (size_t)count);
        batch_hash_add(&blake2, bytes, (size_t)count);
        out->bytes += (uint64_t)count;
    }
    batch_sha256_end(&sha256, out->sha256);
    batch_digest found = batch_hash_end(&blake2);
    return batch_digest_equal(&found, &output->digest);
}

static bool put_output(batch_remote *remote, const batch_output *output, batch_blob *out)
{
    int fd = open(output->path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    bool good = fd >= 0 && hash_file(fd, output, out);
    if (good) {
        place to = place_of("cas", out->sha256);
        good = put_entry(remote, &to, NULL, fd, out->bytes);
    }
    if (fd >= 0)
        close(fd);
    return good;
}

/* The files that the record names are put first among the lists, if they are not there yet. Of two
 * that do it at once one may be lost: then it is put again. */
static void put_list(batch_run *run, cli_arena *arena, const batch_job *job,
                     const batch_record *record, const char *own)
{
    char name[BATCH_SHA256_TEXT];
    if (!name_lists(run, arena, job, &record->key, name))
        return;
    const char *there = get_lists(run->remote, arena, name);
    there = there ? there : "";
    const char *at = there, *end = there;
    for (int i = 0; at && *at && i < LISTS_MOST; i++, at = next_list(at)) {
        if (strncmp(at, own, strlen(own)) == 0)
            return;
        end = i < LISTS_MOST - 1 && next_list(at) ? next_list(at) : end;
    }
    batch_action action = {0};
    batch_blob blob;
    const char *text = cli_arena_printf(arena, "%s%.*s", own, (int)(end - there), there);
    if (!arena->failed && put_text(run->remote, text, &blob) &&
        batch_action_add(arena, &action, &blob))
        put_action(run->remote, arena, name, &action);
}

/* What is named is put before what names it. */
void batch_remote_store(batch_run *run, cli_arena *arena, const batch_job *job,
                        const batch_record *record)
{
    char name[BATCH_SHA256_TEXT];
    batch_action action = {0};
    batch_record timeless = batch_record_timeless(arena, record);
    const char *text = batch_record_print(arena, job, &timeless);
    const char *list = list_of(arena, job, record);
    batch_blob blob = {.bytes = 0};
    bool good = text && list && !arena->failed && !atomic_load(&run->remote->takes_nothing) &&
                put_text(run->remote, text, &blob) && batch_action_add(arena, &action, &blob);
    for (size_t i = 0; i < record->output_count && good; i++)
        good = put_output(run->remote, &record->outputs[i], &blob) &&
               batch_action_add(arena, &action, &blob);
    if (good && name_result(run, arena, job, list, name) &&
        put_action(run->remote, arena, name, &action))
        put_list(run, arena, job, record, list);
}
