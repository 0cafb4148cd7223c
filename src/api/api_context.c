/* SPDX-License-Identifier: MIT
 * The context of the public interface: options in, one object that owns memory budget, diagnostic
 * sink, limits, instruction set and workers out. The one place where the environment is read
 * (CSGMESH_ISA).
 */
#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "api/options.h"
#include "base/context.h"
#include "base/pool.h"
#include "base/ranks.h"
#include "base/scene_codes.h"
#include "base/trace.h"
#include "field/kernels/dispatch.h"
#include "io/file.h"
#include "mesh/pipeline/survey.h"

/* More workers than this never helped, and each costs a stack. */
enum { THREADS_MOST = 1024 };

#define TO_TEXT(x) #x
#define VERSION_TEXT(major, minor, patch) TO_TEXT(major) "." TO_TEXT(minor) "." TO_TEXT(patch)

const char *csgm_version(void)
{
    return VERSION_TEXT(CSGM_VERSION_MAJOR, CSGM_VERSION_MINOR, CSGM_VERSION_PATCH);
}

const char *csgm_status_name(csgm_status status)
{
    static const char *const names[] = {
        [CSGM_OK] = "OK",
        [CSGM_ERR_ARGUMENT] = "ERR_ARGUMENT",
        [CSGM_ERR_SYNTAX] = "ERR_SYNTAX",
        [CSGM_ERR_SCENE] = "ERR_SCENE",
        [CSGM_ERR_LIMIT] = "ERR_LIMIT",
        [CSGM_ERR_MEMORY] = "ERR_MEMORY",
        [CSGM_ERR_IO] = "ERR_IO",
        [CSGM_ERR_FORMAT] = "ERR_FORMAT",
        [CSGM_ERR_UNSUPPORTED] = "ERR_UNSUPPORTED",
        [CSGM_ERR_INTERNAL] = "ERR_INTERNAL",
        [CSGM_CANCELLED] = "CANCELLED",
    };
    return (size_t)status < sizeof names / sizeof *names ? names[status] : "unknown";
}

csgm_context_options csgm_context_options_default(void)
{
    return (csgm_context_options){
        .struct_size = sizeof(csgm_context_options),
        .isa = CSGM_ISA_AUTO,
        .limits = {.depth = 10000,
                   .scene_nodes = 4000000,
                   .eval_steps = 1000000000,
                   .memory_bytes = 8ULL << 30},
    };
}

static uint32_t usable_cores(void)
{
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0 && CPU_COUNT(&set) > 0)
        return (uint32_t)CPU_COUNT(&set);
    long online = sysconf(_SC_NPROCESSORS_ONLN);
    return online > 0 ? (uint32_t)online : 1;
}

/* False when CSGMESH_ISA names nothing that this build has. */
static bool isa_from_environment(csgm_isa *isa)
{
    const char *name = getenv("CSGMESH_ISA");
    if (!name || !*name)
        return true;
    for (csgm_isa i = CSGM_ISA_SCALAR; i <= CSGM_ISA_SIMD128; i++) {
        if (strcmp(name, csg_isa_name(i)) == 0) {
            *isa = i;
            return true;
        }
    }
    return strcmp(name, "auto") == 0;
}

static void release_context(csgm_context *context, csgm_allocator allocator)
{
    if (allocator.release)
        allocator.release(allocator.user, context, sizeof *context);
    else
        free(context);
}

static void fill_context(csgm_context *context, const csgm_context_options *options)
{
    memset(context, 0, sizeof *context);
    csg_memory_init(&context->memory, &options->allocator, options->limits.memory_bytes);
    context->diags.on_diag = options->on_diag;
    context->diags.user = options->user;
    context->diags.warnings_as_errors = options->warnings_as_errors;
    context->diags.library_warnings = options->library_warnings;
    context->limits = options->limits;
    context->on_echo = options->on_echo;
    context->cancelled = options->cancelled;
    context->cancel_user = options->user;
    context->on_file = options->on_file;
    context->file_user = options->user;
    context->user = options->user;
}

static csgm_status start_context(csgm_context *context, const csgm_context_options *options)
{
    csgm_isa wanted = options->isa;
    if (wanted == CSGM_ISA_AUTO && !isa_from_environment(&wanted)) {
        csg_diag_plain(&context->diags, CSG_DIAG_BAD_ENVIRONMENT, NULL,
                       "use auto, scalar, or on x86-64 sse2, avx2, avx512, on ARM neon, in "
                       "WebAssembly simd128",
                       "CSGMESH_ISA names no instruction set that this build has: '%.40s'",
                       getenv("CSGMESH_ISA"));
        return CSGM_ERR_ARGUMENT;
    }
    context->isa = csg_cpu_best_isa(wanted);
    uint32_t threads = options->threads ? options->threads : usable_cores();
    context->pool =
        csg_pool_create(&context->memory, threads < THREADS_MOST ? threads : THREADS_MOST);
    if (!context->pool)
        return csg_context_no_memory(context);
    if (options->trace) {
        context->trace = csg_trace_enter(options->trace, csg_pool_threads(context->pool));
        if (!context->trace) {
            csg_pool_destroy(context->pool);
            return csg_context_no_memory(context);
        }
        csg_pool_set_trace(context->pool, context->trace);
    }
    return CSGM_OK;
}

csgm_status csgm_context_create(const csgm_context_options *options, csgm_context **out)
{
    csgm_context_options own = csgm_context_options_default();
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!csg_options_adopt(&own, sizeof own, options))
        return CSGM_ERR_ARGUMENT;
    options = &own;
    csgm_allocator allocator = own.allocator;
    if (!allocator.alloc != !allocator.release || (unsigned)options->isa > CSGM_ISA_SIMD128)
        return CSGM_ERR_ARGUMENT;
    csgm_context *context = allocator.alloc ? allocator.alloc(allocator.user, sizeof *context)
                                            : malloc(sizeof *context);
    if (!context)
        return CSGM_ERR_MEMORY;
    fill_context(context, options);
    csgm_status status = start_context(context, options);
    if (status == CSGM_OK)
        *out = context;
    else
        release_context(context, allocator);
    return status;
}

void csgm_context_destroy(csgm_context *context)
{
    if (!context)
        return;
    csg_files_release(context, false);
    csg_pool_destroy(context->pool);
    csg_trace_leave(context->trace);
    csg_survey_destroy(context->survey);
    csg_ranks_leave(context);
    release_context(context, context->memory.allocator);
}

uint64_t csgm_context_memory(const csgm_context *context, uint64_t *peak_bytes)
{
    if (peak_bytes)
        *peak_bytes = atomic_load(&context->memory.peak_bytes);
    return atomic_load(&context->memory.used_bytes);
}

uint32_t csgm_context_threads(const csgm_context *context)
{
    return csg_pool_threads(context->pool);
}

void csgm_context_rest(csgm_context *context)
{
    csg_pool_rest(context->pool);
}

const char *csgm_context_isa(const csgm_context *context)
{
    return csg_isa_name(context->isa);
}
