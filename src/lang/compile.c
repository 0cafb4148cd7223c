/* SPDX-License-Identifier: MIT
 * The door of the layer: text in, sealed scene out (lang.h).
 *
 * Parsing and evaluation recurse as deep as the scene nests, so they run on a thread of their own
 * with a large stack (address space only, until it is used) and stop with a finding before its end.
 * The caller's callbacks must run on the caller's thread: the worker hands each one over and waits.
 */
#include "lang/lang.h"

#include <errno.h>
#include <pthread.h>
#include <string.h>
#include <time.h>

#include "base/clock.h"
#include "lang/evaluator.h"
#include "lang/loader.h"

enum { MAILBOX = 16384 };

typedef struct relay { /* callbacks from the worker to the caller */
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    char mailbox[MAILBOX]; /* echoes, each after its length: the worker does not wait for these */
    size_t mail_length;
    const csgm_diag *diag; /* one finding, or one echo too long for the mailbox: it waits */
    const char *text;
    size_t text_length;
    bool done; /* the worker has ended */
} relay;

typedef struct compilation {
    csgm_context *context;
    const csg_lang_input *input;
    csgm_scene_options options;
    csgm_scene **out;
    csgm_status status;
    size_t stack_bytes;
    relay relay;
    csgm_diag_fn *on_diag; /* the caller's */
    csgm_text_fn *on_echo;
    void *diag_user, *echo_user;
} compilation;

/* ---- -D
 * ------------------------------------------------------------------------------------------ */

static bool is_name(const char *text)
{
    size_t i = text[0] == '$';
    for (; text[i]; i++) {
        char c = text[i];
        bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
        if (!letter && !(c >= '0' && c <= '9' && i > 0))
            return false;
    }
    return i > (text[0] == '$');
}

static bool add_assignment(csg_program *program, csg_assignment made)
{
    csg_scope *scope = program->files[0]->scope;
    csg_assignment *place = csg_arena_push(&program->arena, (void **)&scope->variables,
                                           &scope->variable_count, sizeof made);
    if (place)
        *place = made;
    return place && csg_members_add(&program->members, scope->id, CSG_MEMBER_VARIABLE, made.name,
                                    scope->variable_count - 1);
}

/* Replaces the assignment of a name in the scene, or adds one. */
static csgm_status define(csg_program *program, csg_symbol name, csg_expression *value)
{
    csg_scope *scope = program->files[0]->scope;
    const csg_symbol_entry *entry = &program->symbols.entries[name];
    csg_assignment made = {name, value, value->whole};
    uint32_t known = csg_members_find(&program->members, scope->id, CSG_MEMBER_VARIABLE, name);
    if (known != UINT32_MAX) {
        scope->variables[known] = made;
        return CSGM_OK;
    }
    if (!entry->special)
        csg_diag_plain(
            &program->context->diags, CSG_DIAG_UNKNOWN_DEFINE, NULL, NULL,
            "the scene assigns no variable '%s' at its top level, -D has nothing to replace",
            entry->name);
    return add_assignment(program, made) ? CSGM_OK : csg_context_no_memory(program->context);
}

static csgm_status apply_define(csg_program *program, const csgm_define *given)
{
    uint32_t source;
    const char *expression = given->expression ? given->expression : "";
    if (!given->name || !is_name(given->name)) {
        csg_diag_plain(&program->context->diags, CSG_DIAG_BAD_DEFINE, NULL, "write -D name=value",
                       "'%.60s' is not the name of a variable", given->name ? given->name : "");
        return CSGM_ERR_SYNTAX;
    }
    const char *label = csg_arena_printf(&program->arena, "-D %s", given->name);
    csg_symbol name = csg_symbol_intern(&program->symbols, given->name, strlen(given->name));
    if (!label || !name)
        return csg_context_no_memory(program->context);
    csgm_status status =
        csg_source_add(&program->sources, label, expression, strlen(expression), &source);
    if (status != CSGM_OK)
        return status;
    csg_expression *value = csg_parse_lone_expression(program, source);
    return value ? define(program, name, value) : CSGM_ERR_SYNTAX;
}

static csgm_status apply_defines(csg_program *program, const csgm_scene_options *options)
{
    csgm_status status = CSGM_OK;
    for (size_t i = 0; i < options->define_count; i++) {
        csgm_status one = apply_define(program, &options->defines[i]);
        if (status == CSGM_OK)
            status = one;
    }
    return status;
}

/* ---- compiling
 * --------------------------------------------------------------------------------------- */

csgm_status csg_program_init(csg_program *program, csgm_context *context)
{
    bool ok = true;
    *program = (csg_program){.context = context};
    csg_arena_init(&program->arena, &context->memory);
    csg_sources_init(&program->sources, context, &program->arena);
    csg_symbols_init(&program->symbols, &context->memory, &program->arena);
    csg_members_init(&program->members, &context->memory);
    csg_builtins_intern(&program->symbols, &ok);
    return ok ? CSGM_OK : csg_context_no_memory(context);
}

static csgm_status open_source(csg_program *program, const csg_lang_input *input, uint32_t *source)
{
    if (input->text)
        return csg_source_add(&program->sources, input->path ? input->path : "-", input->text,
                              input->text_length, source);
    csg_source_request request = {input->path, csg_span_nowhere(), true};
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
    uint32_t source;
    csgm_status status = open_source(program, c->input, &source);
    if (status != CSGM_OK)
        return status;
    status = csg_parse_program(program, source, &c->options);
    if (status == CSGM_ERR_MEMORY || status == CSGM_ERR_LIMIT)
        return status;
    csgm_status defines = apply_defines(program, &c->options);
    return status != CSGM_OK ? status : defines;
}

static void warn_empty(csg_eval *e, const csgm_scene *scene)
{
    if (scene->nodes[scene->root].kind == CSG_NODE_EMPTY)
        csg_diag_plain(&e->context->diags, CSG_DIAG_EMPTY_SOLID,
                       e->program->sources.items[e->program->files[0]->source].name, NULL,
                       "the scene is an empty solid");
}

static csgm_status evaluate(csg_program *program, uint32_t errors, csgm_scene **out)
{
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
    if (status == CSGM_OK) {
        status = csg_build_finish(&e.builder, root, program->dependencies,
                                  program->dependency_count, &scene);
        if (status == CSGM_ERR_MEMORY)
            csg_context_no_memory(program->context);
    }
    if (status == CSGM_OK)
        warn_empty(&e, scene);
    if (status == CSGM_OK && program->context->diags.errors > errors) {
        csg_scene_destroy(scene);
        status = CSGM_ERR_SCENE;
    }
    csg_eval_reset(&e);
    if (status == CSGM_OK)
        *out = scene;
    return status;
}

static void compile(compilation *c)
{
    csg_program program;
    uint32_t errors = c->context->diags.errors;
    char here;
    c->status = csg_program_init(&program, c->context);
    if (c->context->limits.timeout_s > 0)
        program.deadline_s = csg_clock_now_s() + c->context->limits.timeout_s;
    program.stack_end = (uintptr_t)&here - c->stack_bytes;
    double begin_s = csg_clock_now_s();
    if (c->status == CSGM_OK)
        c->status = parse(&program, c);
    double parsed_s = csg_clock_now_s();
    if (c->status == CSGM_OK)
        c->status = evaluate(&program, errors, c->out);
    if (c->status == CSGM_OK) {
        (*c->out)->parse_s = parsed_s - begin_s;
        (*c->out)->evaluate_s = csg_clock_now_s() - parsed_s;
    }
    csg_program_reset(&program);
}

/* ---- the worker
 * ------------------------------------------------------------------------------------------ */

static void hand_over(relay *r)
{
    pthread_cond_broadcast(&r->changed);
    while (r->diag || r->text)
        pthread_cond_wait(&r->changed, &r->mutex);
}

static void relay_diag(void *user, const csgm_diag *diag)
{
    compilation *c = user;
    pthread_mutex_lock(&c->relay.mutex);
    c->relay.diag = diag;
    hand_over(&c->relay);
    pthread_mutex_unlock(&c->relay.mutex);
}

/* Mutex held; there is room or will be. */
static void post(relay *r, const char *text, size_t length)
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
        post(&c->relay, text, length);
    } else {
        c->relay.text = text;
        c->relay.text_length = length;
        hand_over(&c->relay);
    }
    pthread_mutex_unlock(&c->relay.mutex);
}

static void *work(void *argument)
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

/* On the caller's thread: delivers what the worker hands over, in order, until it ends. Echoes
 * gather for a while: waking for each one would cost more than evaluating it. */
static void serve(compilation *c)
{
    relay *r = &c->relay;
    bool late = false;
    pthread_mutex_lock(&r->mutex);
    while (!r->done || r->diag || r->text || r->mail_length) {
        bool due = late || r->mail_length > MAILBOX / 2 || r->diag || r->text || r->done;
        late = false;
        if (r->mail_length && due) {
            deliver_mail(c);
        } else if (r->diag || r->text) {
            if (r->diag)
                c->on_diag(c->diag_user, r->diag);
            else
                c->on_echo(c->echo_user, r->text, r->text_length);
            r->diag = NULL;
            r->text = NULL;
            pthread_cond_broadcast(&r->changed);
        } else {
            late = wait_a_little(r);
        }
    }
    pthread_mutex_unlock(&r->mutex);
}

/* The largest stack that the system gives; false when it gives no thread. */
static bool start(compilation *c, pthread_t *thread)
{
    static const size_t sizes[] = {(size_t)512 << 20, (size_t)64 << 20, (size_t)8 << 20};
    bool started = false;
    pthread_attr_t attributes;
    if (pthread_attr_init(&attributes) != 0)
        return false;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes && !started; i++) {
        c->stack_bytes = sizes[i] - ((size_t)64 << 10);
        started = pthread_attr_setstacksize(&attributes, sizes[i]) == 0 &&
                  pthread_create(thread, &attributes, work, c) == 0;
    }
    pthread_attr_destroy(&attributes);
    return started;
}

static void run(compilation *c)
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
    bool started = start(c, &thread);
    if (started) {
        serve(c);
        pthread_join(thread, NULL);
    }
    diags->on_diag = c->on_diag;
    diags->user = c->diag_user;
    context->on_echo = c->on_echo;
    context->user = c->echo_user;
    pthread_cond_destroy(&c->relay.changed);
    pthread_mutex_destroy(&c->relay.mutex);
    if (!started) {
        c->stack_bytes = (size_t)512 << 10; /* of the caller's own stack */
        compile(c);
    }
}

csgm_status csg_lang_compile(csgm_context *context, const csg_lang_input *input, csgm_scene **out)
{
    if (!context || !input || !out || (!input->text && !input->path))
        return CSGM_ERR_ARGUMENT;
    compilation c = {.context = context, .input = input, .out = out};
    if (input->options)
        c.options = *input->options;
    c.on_diag = context->diags.on_diag;
    c.diag_user = context->diags.user;
    c.on_echo = context->on_echo;
    c.echo_user = context->user;
    run(&c);
    return c.status;
}
