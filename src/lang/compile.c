/* SPDX-License-Identifier: MIT
 * The door of the layer: text in, sealed scene out (lang.h).
 *
 * Parsing and evaluation recurse as deep as the scene nests, so they run on a thread of their own
 * with a large stack (address space only, until it is used) and stop with a finding before its end.
 * The caller's callbacks must run on the caller's thread: the worker hands each one over and waits.
 */
#include "base/scene_codes.h"
#include "lang/lang.h"

#include <errno.h>
#include <pthread.h>
#include <string.h>
#include <time.h>

#include "base/clock.h"
#include "base/trace.h"
#include "lang/modules/modules.h"
#include "lang/parameters/customizer.h"
#include "lang/parameters/overrides.h"
#include "lang/parse/parser.h"
#include "scene/tree/texts.h"

enum { MAILBOX = 16384 };

typedef struct relay { /* callbacks from the worker to the caller */
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    char mailbox[MAILBOX]; /* echoes, each after its length: the worker does not wait for these */
    size_t mail_length;
    const csgm_diag *diag; /* one finding, or one echo too long for the mailbox: it waits */
    const char *text;
    size_t text_length;
    const char *path; /* or a file that was looked for */
    bool is_there;
    bool done; /* the worker has ended */
} relay;

typedef struct compilation {
    csgm_context *context;
    const csg_lang_input *input;
    csgm_scene_options options;
    csgm_scene **out;    /* NULL: it is not asked for */
    csgm_params *params; /* filled then */
    bool only_syntax;    /* neither is asked for, and no other file is read */
    csgm_status status;
    size_t stack_bytes;
    relay relay;
    csgm_diag_fn *on_diag; /* the caller's */
    csgm_text_fn *on_echo;
    csgm_file_fn *on_file;
    void *diag_user, *echo_user, *file_user;
} compilation;

/* ---- compiling
 * --------------------------------------------------------------------------------------- */

static const csg_builtins builtins = {.call_function = csg_functions_call,
                                      .run_module = csg_modules_run};

static csgm_status intern_builtins(csg_program *program)
{
    bool ok = true;
    csg_functions_intern(&program->symbols, &ok);
    csg_modules_intern(&program->symbols, &ok);
    csg_unsupported_intern(&program->symbols, &ok);
    program->builtins = &builtins;
    return ok ? CSGM_OK : csg_context_no_memory(program->context);
}

static csgm_status open_source(csg_program *program, const csg_lang_input *input, uint32_t *source)
{
    if (input->text)
        return csg_source_add(&program->sources, input->path ? input->path : "-", input->text,
                              input->text_length, source);
    csg_source_request request = {input->path, csg_span_nowhere(), true, NULL};
    csgm_status status = csg_source_read(&program->sources, &request, source);
    if (status != CSGM_OK)
        return status;
    const char **place = csg_arena_push(&program->arena, (void **)&program->dependencies,
                                        &program->dependency_count, sizeof *place);
    if (!place)
        return csg_context_no_memory(program->context);
    *place = program->sources.items[*source].name;
    return CSGM_OK;
}

static csgm_status parse(csg_program *program, const compilation *c)
{
    CSG_ZONE(program->context, "parse");
    uint32_t source;
    csgm_status status = open_source(program, c->input, &source);
    if (status != CSGM_OK)
        return status;
    program->is_alone = c->only_syntax;
    status = csg_parse_program(program, source, &c->options);
    if (c->only_syntax)
        return status;
    if (status == CSGM_OK && c->params)
        status = csg_customizer_collect(program, c->params);
    if (status == CSGM_ERR_MEMORY || status == CSGM_ERR_LIMIT)
        return status;
    csgm_status overrides = csg_overrides_apply(program, &c->options);
    return status != CSGM_OK ? status : overrides;
}

static void warn_empty(csg_eval *e, const csgm_scene *scene)
{
    if (scene->nodes[scene->root].kind == CSG_NODE_EMPTY)
        csg_diag_plain(&e->context->diags, CSG_DIAG_EMPTY_SOLID,
                       e->program->sources.items[e->program->files[0]->source].name, NULL,
                       "the scene is an empty solid");
}

/* For findings of meshing. */
static bool keep_texts(const csg_program *program, csgm_scene *scene)
{
    csg_memory *memory = &program->context->memory;
    const csg_sources *sources = &program->sources;
    size_t bytes = (sources->count + 1) * sizeof(csg_scene_text);
    csg_scene_text *texts = csg_memory_alloc(memory, bytes);
    for (size_t i = 0; texts && i < sources->count; i++) {
        const csg_source *source = &sources->items[i];
        texts[i] = (csg_scene_text){source->name, source->text, source->length};
    }
    bool kept = texts && csg_scene_keep_texts(scene, texts, sources->count);
    csg_memory_release(memory, texts, bytes);
    return kept;
}

/* What modifiers mark, as scenes of their own. */
static csgm_status seal_marks(csg_eval *e, csgm_scene *out[CSGM_MARK_COUNT])
{
    csgm_status status = CSGM_OK;
    for (int i = 0; i < CSGM_MARK_COUNT && status == CSGM_OK; i++)
        if (e->marked[i] != CSG_NODE_NONE)
            status = csg_build_snapshot(&e->builder, e->marked[i], &out[i]);
    return status == CSGM_ERR_MEMORY ? csg_context_no_memory(e->context) : status;
}

static csgm_status seal(csg_eval *e, csg_node_id root, csgm_scene **out)
{
    CSG_ZONE(e->context, "seal");
    const csg_program *program = e->program;
    csgm_scene *marked[CSGM_MARK_COUNT] = {NULL, NULL};
    csgm_status status = seal_marks(e, marked);
    if (status == CSGM_OK) {
        status = csg_build_finish(&e->builder, root, program->dependencies,
                                  program->dependency_count, out);
        if (status == CSGM_ERR_MEMORY)
            csg_context_no_memory(e->context);
    }
    for (int i = 0; i < CSGM_MARK_COUNT; i++)
        if (status == CSGM_OK)
            (*out)->marked[i] = marked[i];
        else
            csg_scene_destroy(marked[i]);
    if (status == CSGM_OK) {
        (*out)->drawing = e->drawing;
        e->drawing = NULL;
    }
    if (status == CSGM_OK)
        csg_zone_count(e->context, "nodes", (*out)->node_count);
    return status;
}

static csgm_status evaluate(csg_program *program, uint32_t errors, csgm_scene **out)
{
    CSG_ZONE(program->context, "evaluate");
    csg_eval e;
    csgm_scene *scene = NULL;
    csg_node_id root = CSG_NODE_NONE;
    csgm_status status = csg_eval_init(&e, program);
    if (status == CSGM_OK) {
        root = csg_eval_run(&e);
        csg_heap_reset(&e.heap); /* sealing needs the room */
        status = e.status;
    }
    if (status == CSGM_OK && program->context->diags.errors > errors)
        status = CSGM_ERR_SCENE; /* warnings as errors */
    if (status == CSGM_OK)
        status = seal(&e, root, &scene);
    if (status == CSGM_OK && !keep_texts(program, scene)) {
        csg_scene_destroy(scene);
        status = csg_context_no_memory(program->context);
    }
    if (status == CSGM_OK) {
        warn_empty(&e, scene);
        bool is_drawing = program->options && program->options->flat == CSGM_FLAT_DRAWING;
        status = is_drawing ? CSGM_OK : csg_warn_lost_parts(&e, scene); /* parts are layers there */
        if (status == CSGM_OK)
            status = csg_warn_joints(&e, scene);
        if (status != CSGM_OK)
            csg_scene_destroy(scene);
    }
    if (status == CSGM_OK && program->context->diags.errors > errors) {
        csg_scene_destroy(scene);
        status = CSGM_ERR_SCENE;
    }
    csg_eval_reset(&e);
    if (status == CSGM_OK && program->options && program->options->only_check)
        csg_scene_destroy(scene);
    else if (status == CSGM_OK)
        *out = scene;
    return status;
}

/* For csg_memory_end_when; on any thread. */
static bool is_late(void *user)
{
    const csg_program *program = user;
    return (program->deadline_s != 0 && csg_clock_now_s() > program->deadline_s) ||
           csg_context_is_cancelled(program->context);
}

static void compile(compilation *c)
{
    CSG_ZONE(c->context, "scene");
    csg_program program;
    uint32_t errors = c->context->diags.errors;
    char here;
    csg_program_init(&program, c->context);
    c->status = intern_builtins(&program);
    if (c->context->limits.timeout_s > 0)
        program.deadline_s = csg_clock_now_s() + c->context->limits.timeout_s;
    program.options = &c->options;
    program.sources.leniency = c->options.leniency;
    program.services = c->input->services;
    program.exact_facets = c->options.facets == CSGM_FACETS_EXACT;
    program.stack_end = (uintptr_t)&here - c->stack_bytes;
    csg_memory_end_when(&c->context->memory, is_late, &program);
    double begin_s = csg_clock_now_s();
    if (c->status == CSGM_OK)
        c->status = parse(&program, c);
    double parsed_s = csg_clock_now_s();
    if (c->status == CSGM_OK && c->params)
        c->status = csg_customizer_take_values(&program, c->params);
    else if (c->status == CSGM_OK && c->out)
        c->status = evaluate(&program, errors, c->out);
    if (c->status == CSGM_OK && c->out && *c->out) {
        (*c->out)->parse_s = parsed_s - begin_s;
        (*c->out)->evaluate_s = csg_clock_now_s() - parsed_s;
    }
    csg_memory_end_when(&c->context->memory, NULL, NULL);
    if (c->status != CSGM_OK && csg_context_is_cancelled(c->context))
        c->status = CSGM_CANCELLED;
    csg_diag_sum_up(&c->context->diags);
    csg_program_reset(&program);
}

/* ---- the worker
 * ------------------------------------------------------------------------------------------ */

static bool has_errand(const relay *r)
{
    return r->diag || r->text || r->path;
}

static void hand_over(relay *r)
{
    pthread_cond_broadcast(&r->changed);
    while (has_errand(r))
        pthread_cond_wait(&r->changed, &r->mutex);
}

static void relay_diag(void *user, const csgm_diag *diag)
{
    compilation *c = user;
    if (diag->severity == CSGM_ERROR && csg_context_is_cancelled(c->context))
        return; /* what failed because of that is nobody's mistake */
    pthread_mutex_lock(&c->relay.mutex);
    c->relay.diag = diag;
    hand_over(&c->relay);
    pthread_mutex_unlock(&c->relay.mutex);
}

/* Mutex held; there is room or will be. */
static void post_echo(relay *r, const char *text, size_t length)
{
    while (r->mail_length + sizeof length + length > MAILBOX)
        pthread_cond_wait(&r->changed, &r->mutex);
    memcpy(r->mailbox + r->mail_length, &length, sizeof length);
    memcpy(r->mailbox + r->mail_length + sizeof length, text, length);
    r->mail_length += sizeof length + length;
    if (r->mail_length > MAILBOX / 2)
        pthread_cond_broadcast(&r->changed);
}

static void relay_echo(void *user, const char *text, size_t length)
{
    compilation *c = user;
    pthread_mutex_lock(&c->relay.mutex);
    if (length <= MAILBOX / 4) {
        post_echo(&c->relay, text, length);
    } else {
        c->relay.text = text;
        c->relay.text_length = length;
        hand_over(&c->relay);
    }
    pthread_mutex_unlock(&c->relay.mutex);
}

static void relay_file(void *user, const char *path, bool is_there)
{
    compilation *c = user;
    pthread_mutex_lock(&c->relay.mutex);
    c->relay.path = path;
    c->relay.is_there = is_there;
    hand_over(&c->relay);
    pthread_mutex_unlock(&c->relay.mutex);
}

static void *compile_in_worker(void *argument)
{
    compilation *c = argument;
    compile(c);
    pthread_mutex_lock(&c->relay.mutex);
    c->relay.done = true;
    pthread_cond_broadcast(&c->relay.changed);
    pthread_mutex_unlock(&c->relay.mutex);
    return NULL;
}

/* Empties the mailbox; the mutex is held, and let go while the caller is called. */
static void deliver_mail(compilation *c)
{
    relay *r = &c->relay;
    char mail[MAILBOX];
    size_t end = r->mail_length, length;
    memcpy(mail, r->mailbox, end);
    r->mail_length = 0;
    pthread_cond_broadcast(&r->changed);
    pthread_mutex_unlock(&r->mutex);
    for (size_t at = 0; at < end; at += sizeof length + length) {
        memcpy(&length, mail + at, sizeof length);
        c->on_echo(c->echo_user, mail + at + sizeof length, length);
    }
    pthread_mutex_lock(&r->mutex);
}

/* Until something changes, or it is time to look into the mailbox (true). */
static bool wait_a_little(relay *r)
{
    enum { LITTLE_NS = 50000000 };
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_nsec += LITTLE_NS;
    if (until.tv_nsec >= 1000000000) {
        until.tv_nsec -= 1000000000;
        until.tv_sec++;
    }
    return pthread_cond_timedwait(&r->changed, &r->mutex, &until) == ETIMEDOUT;
}

/* Mutex held. */
static void run_errand(compilation *c)
{
    relay *r = &c->relay;
    if (r->diag)
        c->on_diag(c->diag_user, r->diag);
    else if (r->text)
        c->on_echo(c->echo_user, r->text, r->text_length);
    else
        c->on_file(c->file_user, r->path, r->is_there);
    r->diag = NULL;
    r->text = NULL;
    r->path = NULL;
    pthread_cond_broadcast(&r->changed);
}

/* On the caller's thread: delivers what the worker hands over, in order, until it ends. Echoes
 * gather for a while: waking for each one would cost more than evaluating it. */
static void serve(compilation *c)
{
    relay *r = &c->relay;
    bool late = false;
    pthread_mutex_lock(&r->mutex);
    while (!r->done || has_errand(r) || r->mail_length) {
        bool due = late || r->mail_length > MAILBOX / 2 || has_errand(r) || r->done;
        late = false;
        if (r->mail_length && due) {
            deliver_mail(c);
        } else if (has_errand(r)) {
            run_errand(c);
        } else {
            late = wait_a_little(r);
        }
    }
    pthread_mutex_unlock(&r->mutex);
}

/* The largest stack that the system gives; false when it gives no thread. */
static bool start_worker(compilation *c, pthread_t *thread)
{
    static const size_t sizes[] = {(size_t)512 << 20, (size_t)64 << 20, (size_t)8 << 20};
    bool started = false;
    pthread_attr_t attributes;
    if (pthread_attr_init(&attributes) != 0)
        return false;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes && !started; i++) {
        c->stack_bytes = sizes[i] - ((size_t)64 << 10);
        started = pthread_attr_setstacksize(&attributes, sizes[i]) == 0 &&
                  pthread_create(thread, &attributes, compile_in_worker, c) == 0;
    }
    pthread_attr_destroy(&attributes);
    return started;
}

static void compile_on_thread(compilation *c)
{
    csgm_context *context = c->context;
    pthread_t thread;
    pthread_mutex_init(&c->relay.mutex, NULL);
    pthread_condattr_t monotonic;
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_cond_init(&c->relay.changed, &monotonic);
    pthread_condattr_destroy(&monotonic);
    csg_diag_sink *diags = &context->diags;
    if (c->on_diag) {
        diags->on_diag = relay_diag;
        diags->user = c;
    }
    context->on_echo = c->on_echo ? relay_echo : NULL;
    context->user = c;
    context->on_file = c->on_file ? relay_file : NULL;
    context->file_user = c;
    bool started = start_worker(c, &thread);
    if (started) {
        serve(c);
        pthread_join(thread, NULL);
    }
    diags->on_diag = c->on_diag;
    diags->user = c->diag_user;
    context->on_echo = c->on_echo;
    context->user = c->echo_user;
    context->on_file = c->on_file;
    context->file_user = c->file_user;
    pthread_cond_destroy(&c->relay.changed);
    pthread_mutex_destroy(&c->relay.mutex);
    if (!started) {
        c->stack_bytes = (size_t)512 << 10; /* of the caller's own stack */
        compile(c);
    }
}

static csgm_status compile_with(compilation *c)
{
    csgm_context *context = c->context;
    if (c->input->options)
        c->options = *c->input->options;
    c->on_diag = context->diags.on_diag;
    c->diag_user = context->diags.user;
    c->on_echo = context->on_echo;
    c->echo_user = context->user;
    c->on_file = context->on_file;
    c->file_user = context->file_user;
    compile_on_thread(c);
    return c->status;
}

csgm_status csg_lang_compile(csgm_context *context, const csg_lang_input *input, csgm_scene **out)
{
    if (!context || !input || !out || (!input->text && !input->path))
        return CSGM_ERR_ARGUMENT;
    return compile_with(&(compilation){.context = context, .input = input, .out = out});
}

csgm_status csg_lang_parameters(csgm_context *context, const csg_lang_input *input,
                                csgm_params **out)
{
    if (!context || !input || !out || (!input->text && !input->path))
        return CSGM_ERR_ARGUMENT;
    uint32_t errors = context->diags.errors;
    csgm_params *params = csg_memory_alloc(&context->memory, sizeof *params);
    if (!params)
        return csg_context_no_memory(context);
    *params = (csgm_params){.context = context};
    csg_arena_init(&params->arena, &context->memory);
    csgm_status status =
        compile_with(&(compilation){.context = context, .input = input, .params = params});
    if (status == CSGM_OK && context->diags.errors > errors)
        status = CSGM_ERR_SCENE; /* warnings as errors */
    if (status == CSGM_OK)
        *out = params;
    else
        csg_params_destroy(params);
    return status;
}

csgm_status csg_lang_check_syntax(csgm_context *context, const csg_lang_input *input)
{
    if (!context || !input || (!input->text && !input->path))
        return CSGM_ERR_ARGUMENT;
    return compile_with(&(compilation){.context = context, .input = input, .only_syntax = true});
}

void csg_params_destroy(csgm_params *params)
{
    if (!params)
        return;
    csg_arena_reset(&params->arena);
    csg_memory_release(&params->context->memory, params, sizeof *params);
}
