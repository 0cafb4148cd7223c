/* SPDX-License-Identifier: MIT
 * Manifests: a JSON file of jobs, {"formats": ["glb"], "jobs": ["mug.txt", {"scene": "knob.txt"}]}.
 * Its schema is share/batch.schema.json.
 */
#ifndef CLI_BATCH_MANIFEST_H
#define CLI_BATCH_MANIFEST_H

#include "batch/batch_options.h"
#include "batch/batch_plan.h"

/* One element of "jobs", over the manifest's own members, under the command line. */
typedef struct batch_entry {
    const char *place;  /* for messages */
    const char *folder; /* of the manifest: scenes and other files are beside it */
    const char *scene;  /* as written; may be a pattern */
    const char *directory, *name, *parameter_file; /* or NULL */
    cli_list formats, sets, outputs;
    batch_settings settings;
} batch_entry;

typedef struct batch_entries {
    batch_entry *items;
    size_t count;
    const char *directory; /* of the manifest, or NULL */
} batch_entries;

/* Adds the manifest's jobs. CLI_DONE, or an exit status after a report. */
int batch_manifest_read(batch_plan *plan, const char *path, batch_entries *entries);

#endif
