/* SPDX-License-Identifier: MIT
 * Records; see batch_record.h. One line a fact:
 *
 *     csgmesh batch 1
 *     key DIGEST
 *     in DIGEST NAME           NAME: "=" the scene, "S/x" beside it, "I2/x" in the third -I folder,
 *     no NAME                        "A/x" by its own path; % and control characters as %0A
 *     out DIGEST BYTES SECONDS NANOSECONDS FORMAT [PART]
 *     took MICROSECONDS        of processor time
 *     end
 */
#include "batch/batch_record.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "batch/batch_names.h"
#include "batch/batch_options.h"
#include "core/textfile.h"
#include "mesh/drawings.h"

batch_digest batch_record_key(const batch_job *job, const batch_digest *program)
{
    batch_hasher hasher;
    batch_hash_begin(&hasher);
    batch_hash_add(&hasher, program->bytes, sizeof program->bytes);
    batch_settings_hash(job->settings, &hasher);
    batch_hash_text(&hasher, job->set ? "set" : "no set");
    if (job->set)
        batch_hash_add(&hasher, job->set_digest.bytes, sizeof job->set_digest.bytes);
    for (size_t i = 0; i < job->formats.count; i++)
        batch_hash_text(&hasher, job->formats.items[i]);
    batch_hash_text(&hasher, job->by_part ? "parts" : "whole");
    batch_hash_text(&hasher, cli_file_name(job->scene)); /* files name their source */
    return batch_hash_end(&hasher);
}

bool batch_record_scene_key(batch_memo *memo, const batch_job *job, const batch_digest *key,
                            batch_digest *out)
{
    batch_digest scene;
    batch_hasher hasher;
    if (!batch_memo_digest(memo, job->scene, &scene))
        return false;
    batch_hash_begin(&hasher);
    batch_hash_add(&hasher, key->bytes, sizeof key->bytes);
    batch_hash_add(&hasher, scene.bytes, sizeof scene.bytes);
    *out = batch_hash_end(&hasher);
    return true;
}

/* ---- names of files ------------------------------------------------------------------- */

/* The folders in which a job's scene looks for files, in their order; NULL past the end. */
static const char *search_folder(cli_arena *arena, const batch_job *job, size_t index)
{
    const cli_list *given = &job->settings->include_dirs;
    csgm_scene_options options = csgm_scene_options_default();
    options.include_dirs = (const char *const *)given->items;
    options.include_dir_count = given->count;
    char folder[4096];
    size_t length = csgm_scene_folder(&options, index, folder, sizeof folder);
    return length > 0 && length < sizeof folder ? cli_arena_strndup(arena, folder, length) : NULL;
}

/* "lib/a.txt" of "parts/lib/a.txt" in "parts"; NULL: it is not below the folder. */
static const char *below(const char *path, const char *folder)
{
    size_t length = strlen(folder);
    if (length && folder[length - 1] == '/')
        length--;
    if (!length)
        return path[0] == '/' || !*path ? NULL : path;
    return strncmp(path, folder, length) == 0 && path[length] == '/' ? path + length + 1 : NULL;
}

static const char *name_of(cli_arena *arena, const batch_job *job, const char *path)
{
    const char *folder, *rest;
    if (strcmp(path, job->scene) == 0)
        return "=";
    for (size_t i = 0; (folder = search_folder(arena, job, i)); i++)
        if ((rest = below(path, folder)))
            return cli_arena_printf(arena, "I%zu/%s", i, rest);
    rest = below(path, cli_path_folder(arena, job->scene));
    return cli_arena_printf(arena, "%c/%s", rest ? 'S' : 'A', rest ? rest : path);
}

/* NULL: a name of no file here. */
static const char *path_of(cli_arena *arena, const batch_job *job, const char *name)
{
    if (strcmp(name, "=") == 0)
        return job->scene;
    const char *slash = strchr(name, '/');
    if (!slash)
        return NULL;
    if (name[0] == 'A')
        return slash + 1;
    if (name[0] == 'S')
        return cli_path_join(arena, cli_path_folder(arena, job->scene), slash + 1);
    const char *folder = search_folder(arena, job, strtoul(name + 1, NULL, 10));
    return folder ? cli_path_join(arena, folder, slash + 1) : NULL;
}

const char *batch_output_path(cli_arena *arena, const batch_job *job, const char *directory,
                              const char *format, const char *part)
{
    if (!part)
        for (size_t i = 0; i < job->outputs.count; i++)
            if (strcmp(job->formats.items[i], format) == 0)
                return job->outputs.items[i];
    batch_name_parts parts = {job->scene, job->folder, job->set, part, format};
    return cli_path_join(arena, directory, batch_name_expand(arena, job->pattern, &parts));
}

/* ---- text ----------------------------------------------------------------------------- */

static void put_escaped(FILE *out, const char *text)
{
    for (; *text; text++)
        if (*text == '%' || (unsigned char)*text < 0x20 || *text == 0x7F)
            fprintf(out, "%%%02X", (unsigned char)*text);
        else
            fputc(*text, out);
}

static const char *unescaped(cli_arena *arena, const char *text)
{
    char *copy = (char *)cli_arena_strdup(arena, text), *to = copy;
    for (const char *from = copy; *from; from++) {
        char code[3] = {from[0] == '%' && from[1] ? from[1] : '\0', '\0', '\0'};
        code[1] = code[0] ? from[2] : '\0';
        if (code[1]) {
            *to++ = (char)strtoul(code, NULL, 16);
            from += 2;
        } else {
            *to++ = *from;
        }
    }
    if (to != copy)
        *to = '\0';
    return copy;
}

static void put_record(FILE *out, cli_arena *arena, const batch_job *job, const batch_record *r)
{
    char digest[BATCH_DIGEST_TEXT];
    batch_digest_print(&r->key, digest);
    fprintf(out, "csgmesh batch 1\nkey %s\n", digest);
    for (size_t i = 0; i < r->input_count; i++) {
        batch_digest_print(&r->inputs[i].digest, digest);
        fprintf(out, "in %s ", digest);
        put_escaped(out, name_of(arena, job, r->inputs[i].path));
        fputc('\n', out);
    }
    for (size_t i = 0; i < r->absent.count; i++) {
        fputs("no ", out);
        put_escaped(out, name_of(arena, job, r->absent.items[i]));
        fputc('\n', out);
    }
    for (size_t i = 0; i < r->output_count; i++) {
        const batch_output *o = &r->outputs[i];
        batch_digest_print(&o->digest, digest);
        fprintf(out, "out %s %" PRIu64 " %" PRId64 " %" PRId64 " %s", digest, o->bytes,
                o->changed_s, o->changed_ns, o->format);
        if (o->part)
            fputc(' ', out);
        put_escaped(out, o->part ? o->part : "");
        fputc('\n', out);
    }
    if (r->cpu_seconds > 0)
        fprintf(out, "took %" PRIu64 "\n", (uint64_t)(r->cpu_seconds * 1e6));
    fputs("end\n", out);
}

const char *batch_record_print(cli_arena *arena, const batch_job *job, const batch_record *record)
{
    cli_text record_text;
    if (cli_text_open(&record_text))
        put_record(record_text.out, arena, job, record);
    char *text = cli_text_close(&record_text);
    const char *copy = text ? cli_arena_strndup(arena, text, record_text.length) : NULL;
    arena->failed = arena->failed || !text;
    free(text);
    return copy;
}

batch_record batch_record_timeless(cli_arena *arena, const batch_record *record)
{
    batch_record timeless = *record;
    size_t size = record->output_count * sizeof *record->outputs;
    timeless.outputs = cli_arena_alloc(arena, size + 1);
    timeless.output_count = timeless.outputs ? record->output_count : 0;
    for (size_t i = 0; i < timeless.output_count; i++) {
        timeless.outputs[i] = record->outputs[i];
        timeless.outputs[i].changed_s = timeless.outputs[i].changed_ns = 0;
    }
    return timeless;
}

const char *batch_record_name(cli_arena *arena, const char *text)
{
    char name[BATCH_DIGEST_TEXT];
    batch_hasher hasher;
    const char *end = strstr(text, "\nend\n"), *took = strstr(text, "\ntook ");
    if (!end || end[5])
        return NULL;
    took = took && took < end ? took : end;
    batch_hash_begin(&hasher);
    batch_hash_text(&hasher, cli_arena_strndup(arena, text, (size_t)(took - text)));
    batch_digest digest = batch_hash_end(&hasher);
    batch_digest_print(&digest, name);
    return cli_arena_strdup(arena, name);
}

static bool parse_input(cli_arena *arena, const batch_job *job, const char *rest, batch_record *out)
{
    batch_input input;
    if (strlen(rest) < BATCH_DIGEST_TEXT || !batch_digest_read(rest, &input.digest))
        return false;
    input.path = path_of(arena, job, unescaped(arena, rest + BATCH_DIGEST_TEXT));
    batch_input *place =
        cli_arena_push(arena, (void **)&out->inputs, &out->input_count, sizeof input);
    if (!place || !input.path)
        return false;
    *place = input;
    return true;
}

static bool parse_output(cli_arena *arena, const batch_job *job, const char *directory,
                         const char *rest, batch_record *out)
{
    batch_output output = {0};
    char format[16];
    int used = 0;
    if (strlen(rest) < BATCH_DIGEST_TEXT || !batch_digest_read(rest, &output.digest))
        return false;
    rest += BATCH_DIGEST_TEXT;
    /* NOLINTNEXTLINE(cert-err34-c): what does not fit is made again */
    if (sscanf(rest, "%" SCNu64 " %" SCNd64 " %" SCNd64 " %15s%n", &output.bytes, &output.changed_s,
               &output.changed_ns, format, &used) != 4 ||
        !cli_drawings_or_mesh_name(format))
        return false;
    output.format = cli_drawings_or_mesh_name(format);
    output.part = rest[used] == ' ' ? unescaped(arena, rest + used + 1) : NULL;
    output.path = batch_output_path(arena, job, directory, output.format, output.part);
    batch_output *place =
        cli_arena_push(arena, (void **)&out->outputs, &out->output_count, sizeof output);
    if (place)
        *place = output;
    return place != NULL;
}

static bool parse_line(cli_arena *arena, const batch_job *job, const char *directory,
                       const char *line, batch_record *out)
{
    if (strncmp(line, "key ", 4) == 0)
        return strlen(line) == 3 + BATCH_DIGEST_TEXT && batch_digest_read(line + 4, &out->key);
    if (strncmp(line, "in ", 3) == 0)
        return parse_input(arena, job, line + 3, out);
    if (strncmp(line, "out ", 4) == 0)
        return parse_output(arena, job, directory, line + 4, out);
    if (strncmp(line, "took ", 5) == 0) {
        out->cpu_seconds = (double)strtoull(line + 5, NULL, 10) * 1e-6;
        return true;
    }
    const char *path = NULL;
    if (strncmp(line, "no ", 3) == 0)
        path = path_of(arena, job, unescaped(arena, line + 3));
    if (path)
        cli_list_add(arena, &out->absent, path);
    return path != NULL;
}

bool batch_record_parse(cli_arena *arena, const batch_job *job, const char *directory,
                        const char *text, batch_record *out)
{
    static const char head[] = "csgmesh batch 1\n";
    *out = (batch_record){0};
    if (strncmp(text, head, sizeof head - 1) != 0)
        return false;
    for (text += sizeof head - 1; *text;) {
        size_t length = strcspn(text, "\n");
        const char *line = cli_arena_strndup(arena, text, length);
        if (strcmp(line, "end") == 0)
            return out->input_count > 0 && !arena->failed;
        if (!text[length] || !parse_line(arena, job, directory, line, out))
            return false;
        text += length + 1;
    }
    return false;
}

/* ---- inputs --------------------------------------------------------------------------- */

static bool is_there(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0;
}

static void note_absent(cli_arena *arena, batch_record *record, const char *path)
{
    for (size_t i = 0; i < record->absent.count; i++)
        if (strcmp(record->absent.items[i], path) == 0)
            return;
    if (!is_there(path))
        cli_list_add(arena, &record->absent, path);
}

/* A file found in a folder of -I was not beside any file that may have asked for it, nor in the
 * folders before. */
static void take_absent(cli_arena *arena, const batch_job *job, batch_record *record,
                        const char *path)
{
    const char *folder, *rest = NULL;
    size_t found = 0;
    while ((folder = search_folder(arena, job, found)) && !(rest = below(path, folder)))
        found++;
    if (!rest)
        return;
    for (size_t i = 0; i < found; i++)
        note_absent(arena, record, cli_path_join(arena, search_folder(arena, job, i), rest));
    for (size_t i = 0; i < record->input_count; i++)
        note_absent(arena, record,
                    cli_path_join(arena, cli_path_folder(arena, record->inputs[i].path), rest));
}

static bool is_later(const struct timespec *a, int64_t seconds, int64_t nanoseconds)
{
    return a->tv_sec > seconds || (a->tv_sec == seconds && a->tv_nsec > nanoseconds);
}

/* A time in the future is a clock that is wrong, not a change. */
static bool changed_since(const char *path, const int64_t since[2])
{
    struct stat status;
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return stat(path, &status) != 0 || (is_later(&status.st_mtim, since[0], since[1]) &&
                                        !is_later(&status.st_mtim, now.tv_sec, now.tv_nsec));
}

bool batch_record_take_inputs(cli_arena *arena, batch_memo *memo, const batch_job *job,
                              const csgm_scene *scene, const int64_t since[2], batch_record *record)
{
    const char *path;
    bool sound = true;
    for (size_t i = 0; (path = csgm_scene_dependency(scene, i)); i++) {
        batch_input input = {.path = cli_arena_strdup(arena, path)};
        if (job->parameter_file && strcmp(path, job->parameter_file) == 0)
            continue; /* the set's own text is part of the key */
        sound = sound && !changed_since(path, since);
        sound = batch_memo_digest(memo, path, &input.digest) && sound;
        batch_input *place =
            cli_arena_push(arena, (void **)&record->inputs, &record->input_count, sizeof input);
        if (place)
            *place = input;
    }
    for (size_t i = 0; i < record->input_count; i++)
        take_absent(arena, job, record, record->inputs[i].path);
    return sound && !arena->failed;
}

bool batch_record_inputs_hold(batch_memo *memo, const batch_record *record)
{
    for (size_t i = 0; i < record->input_count; i++) {
        batch_digest now;
        if (!batch_memo_digest(memo, record->inputs[i].path, &now) ||
            !batch_digest_equal(&now, &record->inputs[i].digest))
            return false;
    }
    for (size_t i = 0; i < record->absent.count; i++)
        if (is_there(record->absent.items[i]))
            return false;
    return true;
}

bool batch_output_look(batch_output *output)
{
    struct stat status;
    if (stat(output->path, &status) != 0 || !S_ISREG(status.st_mode))
        return false;
    output->bytes = (uint64_t)status.st_size;
    output->changed_s = status.st_mtim.tv_sec;
    output->changed_ns = status.st_mtim.tv_nsec;
    return true;
}
