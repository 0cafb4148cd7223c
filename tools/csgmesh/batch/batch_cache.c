/* SPDX-License-Identifier: MIT
 * A cache in a folder, also one of a network file system:
 *
 *     CACHE/KK/KEY/RECORD                   records of jobs with this program, options and scene
 *     CACHE/objects/DD/DIGEST               outputs, by their bytes
 *
 * All of it may be deleted at any time. Files appear whole under names made of their contents, and
 * what is read must have the digest of its name, so that no machine needs to wait for another and
 * none needs locks: where a writer was killed, the disk was full or a block was lost, an entry is
 * missing, or refused and written again.
 */
#include "batch/batch_cache.h"

#include <dirent.h>
#include <errno.h>
#include <string.h>
#include <sys/stat.h>

#include "batch/batch_report.h"
#include "core/options.h"

static const char *object_path(cli_arena *arena, const char *cache, const batch_digest *digest)
{
    char name[BATCH_DIGEST_TEXT];
    batch_digest_print(digest, name);
    return cli_arena_printf(arena, "%s/objects/%.2s/%s", cache, name, name);
}

/* The folder of all records with this key and this text of the scene; NULL: it cannot be read. */
static const char *records_folder(cli_arena *arena, batch_run *run, const batch_job *job,
                                  const batch_digest *key)
{
    batch_digest both;
    char name[BATCH_DIGEST_TEXT];
    if (!batch_record_scene_key(&run->memo, job, key, &both))
        return NULL;
    batch_digest_print(&both, name);
    return cli_arena_printf(arena, "%s/%.2s/%s", run->app->options->cache, name, name);
}

/* ---- taking --------------------------------------------------------------------------- */

/* Outputs that are not there in the cache, or broken, leave the job to be made. */
static bool install(batch_run *run, cli_arena *arena, batch_record *record)
{
    const cli_options *options = run->app->options;
    for (size_t i = 0; i < record->output_count; i++) {
        batch_output *output = &record->outputs[i];
        const char *object = object_path(arena, options->cache, &output->digest);
        if (!batch_make_folders(output->path, false) ||
            !batch_copy(object, output->path, &output->digest, true, !options->no_sync) ||
            !batch_output_look(output))
            return false;
    }
    return true;
}

static bool try_record(batch_run *run, cli_arena *arena, const batch_job *job, const char *folder,
                       const char *name, const batch_digest *key, batch_record *record)
{
    size_t length;
    const char *text = batch_read_small(arena, cli_path_join(arena, folder, name), &length);
    const char *right = text ? batch_record_name(arena, text) : NULL;
    return right && strcmp(name, right) == 0 &&
           batch_record_is_taken(run, arena, job, key, text, record) && install(run, arena, record);
}

bool batch_cache_take(batch_run *run, cli_arena *arena, const batch_job *job,
                      const batch_digest *key, batch_record *record)
{
    const char *folder = records_folder(arena, run, job, key);
    DIR *directory = folder ? opendir(folder) : NULL;
    const struct dirent *entry;
    bool found = false;
    while (directory && !found && (entry = readdir(directory)))
        found = entry->d_name[0] != '.' &&
                try_record(run, arena, job, folder, entry->d_name, key, record);
    if (directory)
        closedir(directory);
    return found;
}

/* ---- storing -------------------------------------------------------------------------- */

/* Once; the outputs are there all the same. EBADMSG: somebody has changed them meanwhile. */
static void warn(batch_run *run, int reason)
{
    if (reason == EBADMSG)
        return;
    pthread_mutex_lock(&run->mutex);
    bool is_told = run->cache_is_full;
    run->cache_is_full = true;
    pthread_mutex_unlock(&run->mutex);
    if (!is_told)
        batch_report_warn(run, "the cache %s does not take all that was made: %s",
                          run->app->options->cache, strerror(reason));
}

/* Nothing is written into a pipe or a device that has an entry's name, nor waited for. */
static bool may_write(const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0 || S_ISREG(status.st_mode))
        return true;
    errno = EEXIST;
    return false;
}

static bool store_objects(batch_run *run, cli_arena *arena, const batch_record *record)
{
    for (size_t i = 0; i < record->output_count; i++) {
        const batch_output *output = &record->outputs[i];
        const char *object = object_path(arena, run->app->options->cache, &output->digest);
        if (!batch_make_folders(object, false) || !may_write(object) ||
            !batch_copy(output->path, object, &output->digest, true, false))
            return false;
    }
    return true;
}

/* The record's name is made of its inputs: the same in every process that finds the same. */
void batch_cache_store(batch_run *run, cli_arena *arena, const batch_job *job,
                       const batch_record *record)
{
    batch_record timeless = batch_record_timeless(arena, record);
    const char *folder = records_folder(arena, run, job, &record->key);
    const char *text = batch_record_print(arena, job, &timeless);
    const char *name = text ? batch_record_name(arena, text) : NULL;
    if (!folder || !name || arena->failed)
        return;
    const char *path = cli_path_join(arena, folder, name);
    if (!store_objects(run, arena, record) || !batch_make_folders(path, false) ||
        !may_write(path) || !batch_write_small(path, text, strlen(text)))
        warn(run, errno);
}
