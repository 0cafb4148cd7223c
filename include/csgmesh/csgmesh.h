/* SPDX-License-Identifier: MIT
 *
 * csgmesh: text scenes -> CSG/blend trees -> watertight triangle meshes.
 *
 * The flow is one way:   text -> scene -> field -> mesh -> file
 *
 * Conventions
 *   Units      Lengths are scene units unless the name says otherwise (_deg, _ms, _s, _bytes).
 *   Axes       Right handed, Z up. f > 0 inside, f < 0 outside; f = 0 counts as inside.
 *   Ownership  *_create, *_parse, *_load, *_compile, *_build, *_read give you an object;
 *              pass it to its *_destroy once. *_destroy(NULL) is a no-op. All else borrows.
 *   Lifetime   A context outlives everything made with it.
 *   Immutable  Scenes, fields and meshes never change after they are made.
 *   Threads    A context belongs to one thread at a time. Scenes, fields and meshes may be
 *              read from any number of threads.
 *   Errors     Fallible calls return csgm_status; *out is NULL unless it is CSGM_OK.
 *              Bad input is an error with a diagnostic. Broken contracts (NULL context,
 *              options not made by *_default) are CSGM_ERR_ARGUMENT. Nothing exits or aborts.
 *   Options    Start from *_default(), then change members. struct_size says which version of the
 *              struct the caller was compiled with: members may be added at its end, and where the
 *              caller's struct ends before them they have their defaults. A size that no version
 *              has had, a larger one too, is CSGM_ERR_ARGUMENT. options NULL = all defaults.
 *   Determinism  Same scene text + options => same bytes, for any thread count and any ISA.
 */
#ifndef CSGMESH_CSGMESH_H
#define CSGMESH_CSGMESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define CSGM_VERSION_MAJOR 0
#define CSGM_VERSION_MINOR 1
#define CSGM_VERSION_PATCH 0

#ifndef CSGM_API
#if defined(__GNUC__)
#define CSGM_API __attribute__((visibility("default")))
#else
#define CSGM_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- vocabulary ------------------------------------------------------------------ */

/* A point or a direction. Points are in scene units. */
typedef struct csgm_vec3 {
    double x, y, z;
} csgm_vec3;

/* A box along the axes, in scene units: all points between its two corners. It is empty when
 * min.x > max.x, and a side may be infinite. */
typedef struct csgm_box {
    csgm_vec3 min, max;
} csgm_box;

/* What a call that can fail returns. */
typedef enum csgm_status {
    CSGM_OK = 0,
    CSGM_ERR_ARGUMENT,    /* the caller broke the contract of the call */
    CSGM_ERR_SYNTAX,      /* the text is not in the language */
    CSGM_ERR_SCENE,       /* well-formed text with no meaning: unknown name, negative radius */
    CSGM_ERR_LIMIT,       /* a budget in csgm_limits was reached */
    CSGM_ERR_MEMORY,      /* the allocator returned NULL, or limits.memory_bytes was reached */
    CSGM_ERR_IO,          /* errno text is in the diagnostic */
    CSGM_ERR_FORMAT,      /* a mesh file that is broken or not of the format it claims */
    CSGM_ERR_UNSUPPORTED, /* this build has no writer/reader for that format */
    CSGM_ERR_INTERNAL,    /* a bug in csgmesh; please report it */
    CSGM_CANCELLED        /* csgm_monitor.cancelled said so */
} csgm_status;

CSGM_API const char *csgm_status_name(csgm_status status); /* "ERR_SYNTAX"; static storage */

/* "0.1.0"; static storage. */
CSGM_API const char *csgm_version(void);

/* ---- diagnostics ----------------------------------------------------------------- */

/* How bad a finding is: a note explains the finding before it, a warning leaves the result usable,
 * an error means that there is no result. */
typedef enum csgm_severity { CSGM_NOTE, CSGM_WARNING, CSGM_ERROR } csgm_severity;

/* One finding about one place of a text or file: what is wrong, where, and what to do about it. The
 * struct and its strings are valid only during the callback. */
typedef struct csgm_diag {
    csgm_severity severity;
    uint16_t code;           /* stable number, printed as E0107; see scenes/README.md */
    const char *source_name; /* what you passed as name or path; NULL = not about a file */
    uint32_t line, column;   /* 1-based; column counts bytes; 0 = not about text */
    uint32_t length;         /* bytes of source the finding covers */
    const char *message;     /* one sentence, no newline: "radius must be positive" */
    const char *hint;        /* what to do, or NULL: "did you mean 'sphere'?" */
    const char *source_line; /* the whole line, not terminated, or NULL */
    uint32_t source_line_length;
    uint32_t end_line, end_column; /* just behind the last byte covered; 0 = not about text */
    const char *library; /* the library whose file the place is in, "BOSL2"; NULL = no library's */
    bool lenient;        /* a warning that would be an error in a strict text (csgm_leniency) */
} csgm_diag;

/* Receives each finding as it is made. */
typedef void csgm_diag_fn(void *user, const csgm_diag *diag);

/* Formats "part.txt:4:9: error E0107: ..." plus the source line, the caret line and the hint,
 * each line ending in '\n'. Returns bytes needed without the terminator; writes at most size
 * bytes including it (snprintf rules). */
CSGM_API size_t csgm_diag_format(const csgm_diag *diag, char *buffer, size_t size);

/* Receives text in pieces, such as the lines that a scene echoes, or a dump. A piece is not
 * terminated by a NUL. */
typedef void csgm_text_fn(void *user, const char *text, size_t length);

/* Receives the path of each file that a scene or a mesh is looked for in, and whether it can be
 * read: those of the search for an include that were not there, too, so that who follows a scene's
 * files sees one come. A path may come more than once. Called on the calling thread only. */
typedef void csgm_file_fn(void *user, const char *path, bool is_there);

/* ---- context: allocator, workers, limits ------------------------------------------ */

/* What all calls share: the allocator, the worker threads, the limits, and where findings go. Make
 * one at the start of your program and keep it until everything made with it is destroyed. */
typedef struct csgm_context csgm_context;

/* Where memory comes from. All zero means malloc and free. The functions are called from any worker
 * thread, so they must be thread safe. */
typedef struct csgm_allocator {
    void *(*alloc)(void *user, size_t size_bytes); /* aligned for any type; NULL = out of memory */
    void (*release)(void *user, void *memory, size_t size_bytes);
    void *user;
} csgm_allocator;

/* The instruction set that the vector code runs on. All give the same bits; they differ in speed.
 */
typedef enum csgm_isa {
    CSGM_ISA_AUTO,
    CSGM_ISA_SCALAR,
    CSGM_ISA_SSE2,
    CSGM_ISA_AVX2,
    CSGM_ISA_AVX512,
    CSGM_ISA_NEON,
    CSGM_ISA_SIMD128 /* of WebAssembly */
} csgm_isa;

/* Budgets that keep a hostile or mistaken scene from exhausting the machine. Reaching one ends the
 * call with CSGM_ERR_LIMIT (memory: CSGM_ERR_MEMORY) and a finding that names it. */
typedef struct csgm_limits {
    uint32_t depth;        /* nesting of text, calls and solids; default 10 000 */
    uint32_t scene_nodes;  /* nodes of the evaluated tree; default 4 million */
    uint64_t eval_steps;   /* language steps, guards endless loops; default 1e9 */
    uint64_t memory_bytes; /* of the context's allocator; default 8 GiB; 0 = no limit */
    double timeout_s;      /* wall clock of one scene's parse and evaluation, of one mesh build, of
                              making the mesh of one file and of an inspection (that of a file:
                              with the making); default 0 = none */
} csgm_limits;

typedef struct csgm_trace csgm_trace; /* see "trace" below */

/* How a context is set up. Start from csgm_context_options_default() and change what you need. */
typedef struct csgm_context_options {
    uint32_t struct_size; /* set by csgm_context_options_default; do not touch */
    csgm_allocator allocator;
    uint32_t threads; /* 0 = one per core; 1 = everything on the calling thread */
    csgm_isa isa;     /* AUTO: the widest this machine runs, or what the environment variable
                         CSGMESH_ISA names; results are equal */
    csgm_limits limits;
    bool warnings_as_errors; /* default false; one while a mesh is written: CSGM_ERR_SCENE, and no
                                file */
    csgm_diag_fn *on_diag;   /* called on the calling thread only; NULL = silent */
    csgm_text_fn *on_echo;   /* whole lines "ECHO: ...\n"; NULL = dropped */
    void *user;              /* passed to on_diag and on_echo */
    bool library_warnings; /* tell each warning whose place is in a library, as those of the scene's
                              own files; default false: one note says how many there are */
    csgm_trace *trace;     /* where its time goes is noted there; outlives it; NULL (the default) =
                              nowhere */
    /* Asked now and then during every call with this context that can take long: reading a scene or
     * a mesh, meshing, drawing, comparing, many points. On any thread: be quick and thread safe.
     * true = the call ends with CSGM_CANCELLED, without a finding about it; say so until it has
     * ended. Gets `user`; NULL (the default) = nobody asks to stop. A call's own csgm_monitor is
     * asked too. */
    bool (*cancelled)(void *user);
    csgm_file_fn *on_file; /* gets `user`; NULL (the default) = nobody follows files */
} csgm_context_options;

CSGM_API csgm_context_options csgm_context_options_default(void);
/* options: NULL means the defaults. */
CSGM_API csgm_status csgm_context_create(const csgm_context_options *options, csgm_context **out);
CSGM_API void csgm_context_destroy(csgm_context *context);
/* Bytes that the context holds now; *peak_bytes (may be NULL) is the most that it has held. Memory
 * of outside libraries that bring their own allocator is not in it. */
CSGM_API uint64_t csgm_context_memory(const csgm_context *context, uint64_t *peak_bytes);
/* The number of threads that long calls use, at least 1. */
CSGM_API uint32_t csgm_context_threads(const csgm_context *context);
/* Ends the worker threads until a call needs them again: for a context that is kept because of what
 * was made with it, and has nothing to do. */
CSGM_API void csgm_context_rest(csgm_context *context);
/* "avx512", "avx2", "sse2", "neon", "simd128" or "scalar"; static storage. */
CSGM_API const char *csgm_context_isa(const csgm_context *context);

/* ---- trace: where the time goes ------------------------------------------------------ */

/* Zones: stretches of a thread's work with a name, from reading the text to waiting for the disk,
 * and each thread's part of each parallel loop. docs/trace.md lists them. Several contexts, at
 * work at the same time, may share a trace; threads of contexts that have ended hand their lanes
 * on to later ones. Meshes have the same bytes with and without a trace. Its memory is its own and
 * counts in no context's limit: at most memory_bytes (0 = 64 MiB, about half a million zones).
 * Zones that find no room are left out and counted. allocator NULL = malloc and free. */
CSGM_API csgm_status csgm_trace_create(const csgm_allocator *allocator, uint64_t memory_bytes,
                                       csgm_trace **out);
/* After all contexts that have it. */
CSGM_API void csgm_trace_destroy(csgm_trace *trace);
/* Zones of your own around calls with this context, on the thread that makes them: begin and end
 * in pairs. Nothing happens in a context without a trace. name: static storage. note (may be NULL):
 * what it is about, as a file's name; copied. */
CSGM_API void csgm_trace_begin(csgm_context *context, const char *name, const char *note);
CSGM_API void csgm_trace_end(csgm_context *context);
/* The JSON of Chrome's trace event format, which Perfetto opens. No context may be at work. */
CSGM_API csgm_status csgm_trace_print(csgm_trace *trace, csgm_text_fn *sink, void *user);
/* How many zones found no room. */
CSGM_API uint64_t csgm_trace_dropped(const csgm_trace *trace);

/* ---- scene: the evaluated CSG/blend tree ------------------------------------------ */

/* An evaluated scene: the tree of solids and operators that a text describes. It knows the field's
 * exact value at every point and never changes. */
typedef struct csgm_scene csgm_scene;

/* A top-level assignment that is made from outside, as -D NAME=EXPR does on the command line. It
 * replaces the assignment in the scene's text. */
typedef struct csgm_define {
    const char *name;       /* "radius" */
    const char *expression; /* in the scene language: "50", "[1, 2]", "\"text\"" */
} csgm_define;

/* What the special variables $fn, $fa and $fs do to curved solids. */
typedef enum csgm_facets {
    CSGM_FACETS_ROUND, /* curves are round, but $fn from 3 to 16 makes a polygon, prism, polytope */
    CSGM_FACETS_EXACT  /* $fn, $fa and $fs hold everywhere, as in OpenSCAD */
} csgm_facets;

/* Mistakes of which OpenSCAD only warns, going on without what they concern: an unknown module or
 * function, a missing include, an argument of the wrong kind, faces without points. */
typedef enum csgm_leniency {
    CSGM_STRICT,          /* they are errors */
    CSGM_LENIENT_BY_FILE, /* warnings in files named .scad or .csg, errors elsewhere: the file in
                             which the mistake stands decides */
    CSGM_LENIENT          /* they are warnings, and say what is left out */
} csgm_leniency;

/* What becomes of a scene that is a flat figure. */
typedef enum csgm_flat {
    CSGM_FLAT_PLATE,   /* a solid, 1 thick, with a warning */
    CSGM_FLAT_DRAWING, /* its outlines are kept for csgm_scene_draw; solids beside it are left out,
                          with a warning, and a scene without a flat figure is an error */
    CSGM_FLAT_BOTH,    /* both; a scene that is a solid is an error */
    CSGM_FLAT_KEPT     /* a flat figure, for dumps: no mesh can be made of it */
} csgm_flat;

/* How a scene's text is read: values from outside, folders of includes, and facets. */
typedef struct csgm_scene_options {
    uint32_t struct_size; /* set by csgm_scene_options_default; do not touch */
    const csgm_define *defines;
    size_t define_count;
    const char *const *include_dirs; /* searched after the including file's own folder */
    size_t include_dir_count;
    /* A set of values from a file in the JSON of OpenSCAD's customizer, both or neither; they
     * replace the scene's own, and defines replace them. */
    const char *parameter_file, *parameter_set;
    csgm_facets facets;        /* default ROUND */
    csgm_leniency leniency;    /* default STRICT */
    uint32_t openscad_version; /* what version_num() says: 20210100 is 2021.01; 0 (the default): the
                                  newest one that is fully supported */
    csgm_flat flat;            /* default PLATE */
    bool only_check;           /* the text is only looked at for mistakes, and no scene is made:
                                  *out stays NULL. Hulls, Minkowski sums and shadows that nothing
                                  else depends on are left out, with what only they would show */
} csgm_scene_options;

CSGM_API csgm_scene_options csgm_scene_options_default(void);

/* The folders in which include, use and import look for what does not stand beside the file that
 * asks, in their order: include_dirs, those of the environment variables CSGMESH_PATH and
 * OPENSCADPATH (colons between), and OpenSCAD's folders of libraries. Writes the name of folder
 * `index` into buffer, at most size bytes with the terminator, and returns its length (snprintf
 * rules); 0 = there are not so many. A folder may not exist. options may be NULL. */
CSGM_API size_t csgm_scene_folder(const csgm_scene_options *options, size_t index, char *buffer,
                                  size_t size);

/* text: UTF-8, text_length bytes, may hold NULs (an error with a place). name: for diagnostics
 * and, where it has a folder, for relative includes. options NULL = defaults. */
CSGM_API csgm_status csgm_scene_parse(csgm_context *context, const char *text, size_t text_length,
                                      const char *name, const csgm_scene_options *options,
                                      csgm_scene **out);
CSGM_API csgm_status csgm_scene_load(csgm_context *context, const char *path,
                                     const csgm_scene_options *options, csgm_scene **out);
CSGM_API void csgm_scene_destroy(csgm_scene *scene);

/* What is known of a scene without meshing it. Lengths are in scene units. */
typedef struct csgm_scene_info {
    csgm_box bounds; /* contains the solid (S-bounds); its sides may be infinite, it may be empty */
    uint32_t primitive_count, operator_count;
    double lipschitz; /* |f(p) - f(q)| <= lipschitz |p - q| */
    bool has_colors;
    double parse_s, evaluate_s; /* wall time that reading the text and evaluating it took */
} csgm_scene_info;

CSGM_API csgm_scene_info csgm_scene_get_info(const csgm_scene *scene);

/* Files read for the scene: the scene itself, then includes, in order of first reading.
 * Returns NULL when index is past the end. */
CSGM_API const char *csgm_scene_dependency(const csgm_scene *scene, size_t index);

/* What modifiers of the text set off from the rest, for those who show the scene. */
typedef enum csgm_mark {
    CSGM_MARK_HIGHLIGHT,  /* #: the solid has it, too */
    CSGM_MARK_BACKGROUND, /* %: the solid has it not */
    CSGM_MARK_COUNT
} csgm_mark;

/* All that is marked so, as a scene of its own that lives as long as this one; NULL = nothing. It
 * may be infinite: give bounds to mesh it. */
CSGM_API const csgm_scene *csgm_scene_get_marked(const csgm_scene *scene, csgm_mark mark);

/* Value and gradient in double precision (operators.md, EvalField), for looking, not for speed.
 * gradient (may be NULL) is zero at critical points. */
CSGM_API double csgm_scene_eval(const csgm_scene *scene, csgm_vec3 at, csgm_vec3 *gradient);
/* The same at many points, by all threads of the context, bit for bit what one point after the
 * other gives: points has 3 * count numbers, values gets count, gradients (may be NULL) 3 * count.
 * After a failure they hold what was known by then. */
CSGM_API csgm_status csgm_scene_eval_points(csgm_context *context, const csgm_scene *scene,
                                            const double *points, size_t count, double *values,
                                            double *gradients);

/* Primitives that can change the value at this point (the others may be pruned there). */
CSGM_API uint32_t csgm_scene_active_primitives(const csgm_scene *scene, csgm_vec3 at);

/* ---- parameters: what a scene offers to be set ----------------------------------------- */

/* The literal assignments at the top of the scene's own file, before its first brace, with what
 * comments in the style of OpenSCAD's customizer say of them:
 *
 *     / * [Size] * /               begins a section (without the blanks at the slashes)
 *     // outer radius              a line of its own above the assignment: the description
 *     radius = 10;                 // [5:0.5:50]  or [max], [a, b], [1:small, 2:large], a step
 */
/* What kind of value a parameter holds. */
typedef enum csgm_param_kind {
    CSGM_PARAM_NUMBER,
    CSGM_PARAM_BOOLEAN,
    CSGM_PARAM_STRING,
    CSGM_PARAM_VECTOR /* of numbers, at least one */
} csgm_param_kind;

/* The value of a parameter: numbers or a text, as its kind says. */
typedef struct csgm_param_value {
    csgm_param_kind kind;
    const double *numbers; /* NUMBER and BOOLEAN (0 or 1): one */
    size_t number_count;
    const char *text; /* STRING, else NULL */
} csgm_param_value;

/* One of the values that a comment offers for a parameter, with the label that people see. */
typedef struct csgm_param_choice {
    const char *label;
    csgm_param_value value; /* NUMBER or STRING */
} csgm_param_choice;

/* A parameter that a scene offers: its name, value and description, and the range that its comment
 * allows. Everything is valid until the csgm_params are destroyed. */
typedef struct csgm_param {
    const char *name;
    const char *section;      /* "Parameters" before the first; "Hidden" is not for people */
    const char *description;  /* or NULL */
    uint32_t line;            /* of the assignment, 1-based */
    csgm_param_value initial; /* in the scene's text */
    csgm_param_value value;   /* after the parameter set and the defines */
    bool is_overridden;       /* by one of these */
    double minimum, maximum;  /* of a number or of each in a vector; NaN = not said */
    double step;              /* NaN = not said */
    uint32_t length_most;     /* characters of a string; 0 = not said */
    const csgm_param_choice *choices;
    size_t choice_count;
} csgm_param;

/* The parameters of one scene, in the order of its text. */
typedef struct csgm_params csgm_params;

/* Parses the scene, with what it includes; evaluates only what a define computes. Arguments as for
 * csgm_scene_parse and csgm_scene_load. */
CSGM_API csgm_status csgm_params_parse(csgm_context *context, const char *text, size_t text_length,
                                       const char *name, const csgm_scene_options *options,
                                       csgm_params **out);
CSGM_API csgm_status csgm_params_load(csgm_context *context, const char *path,
                                      const csgm_scene_options *options, csgm_params **out);
CSGM_API void csgm_params_destroy(csgm_params *params);
/* In the order of the text; NULL when index is past the end. */
CSGM_API const csgm_param *csgm_params_get(const csgm_params *params, size_t index);

/* ---- field: the scene compiled to a tape ------------------------------------------ */

/* A scene compiled to a tape, a flat list of operations that the vector code runs: the form in
 * which a scene is meshed and rendered. */
typedef struct csgm_field csgm_field;

/* The scene must outlive the field. */
CSGM_API csgm_status csgm_field_compile(csgm_context *context, const csgm_scene *scene,
                                        csgm_field **out);
CSGM_API void csgm_field_destroy(csgm_field *field);
/* The parts that its mesh has, in order, as far as they have a surface; false when index is past
 * the end. *name: until the field is destroyed, NULL = without a name (a scene without parts is
 * one). */
CSGM_API bool csgm_field_part(const csgm_field *field, size_t index, const char **name);

/* Field values in float at count points (scene units) given as three arrays; out must not
 * overlap them. Bit-equal on every ISA. */
CSGM_API void csgm_field_eval(const csgm_field *field, const float *x, const float *y,
                              const float *z, float *out, size_t count);

/* ---- watching and stopping long calls ---------------------------------------------- */

/* The stages of which a monitor is told. */
typedef enum csgm_stage {
    CSGM_STAGE_OCTREE,
    CSGM_STAGE_MESH,
    CSGM_STAGE_WRITE,
    CSGM_STAGE_RENDER,
    CSGM_STAGE_RESHAPE, /* of csgm_mesh_options.tolerance, simplify and improve, with its proofs */
    CSGM_STAGE_CERTIFY,
    CSGM_STAGE_COMPARE, /* csgm_diff_meshes */
    CSGM_STAGE_MEASURE, /* csgm_measure_field */
    CSGM_STAGE_COUNT
} csgm_stage;

/* Watches a long call and can stop it. All zero means that nobody watches. */
typedef struct csgm_monitor {
    /* On the calling thread, at most about 20 times a second; a stage's fraction never falls. */
    void (*progress)(void *user, csgm_stage stage, double fraction);
    /* On any worker, about once per block: be quick and thread safe. true = stop. */
    bool (*cancelled)(void *user);
    void *user;
} csgm_monitor;

/* ---- mesh ------------------------------------------------------------------------- */

/* A triangle mesh in memory. Look at its arrays through csgm_mesh_get_view. */
typedef struct csgm_mesh csgm_mesh;

/* Which normals a mesh has. A sheet is one of the smooth pieces of surface that meet at a crease.
 */
typedef enum csgm_normals {
    CSGM_NORMALS_NONE,
    CSGM_NORMALS_VERTEX, /* one per vertex: the field's gradient; at a crease, the mean of the
                            sheets' gradients. Of meshes that were thinned out, those with which
                            triangles show the surface's own best in the mean */
    CSGM_NORMALS_CREASE  /* at creases and corners there is a vertex for each sheet, one after the
                            other and with bit-equal positions: the mesh is closed once vertices of
                            equal position are welded */
} csgm_normals;

/* Whether sharp edges and corners of the solid are kept. */
typedef enum csgm_features {
    CSGM_FEATURES_SHARP, /* creases, corners and tips of the solid are edges and vertices of the
                            mesh (extended marching cubes, Kobbelt et al. 2001) */
    CSGM_FEATURES_SMOOTH /* plain marching cubes: they are cut by up to a cell */
} csgm_features;

/* Meshes of a lattice that follows the shape, which resolution and cell_size 0 give: cells are
 * small where it asks for that, and the mesh is thinned out. The tolerance T is the largest power
 * of two that is at most a share of the longest side of the bounds. Every triangle is within T of
 * the surface as sampled, and parts and gaps thicker than T are looked for; nothing is proven,
 * which `tolerance` does. */
typedef enum csgm_quality {
    CSGM_QUALITY_NORMAL, /* T: a 1000th of the longest side; what options of zeros mean */
    CSGM_QUALITY_DRAFT,  /* a 250th */
    CSGM_QUALITY_FINE    /* a 4000th */
} csgm_quality;

/* How a field is meshed: where, how finely, and what is done to the triangles. Lengths are in scene
 * units. */
typedef struct csgm_mesh_options {
    uint32_t struct_size; /* set by csgm_mesh_options_default; do not touch */
    csgm_box bounds;      /* what to mesh, the solid is cut and capped there; empty (the default) =
                             the scene's own bounds */
    double cell_size;     /* edge of a marching-cubes cell; 0 (the default): as resolution says */
    uint32_t resolution;  /* cells along the longest side when cell_size is 0; 0 (the default):
                             128 to certify, else cells follow the shape as tolerance, quality
                             and triangles say */
    csgm_normals normals; /* default VERTEX */
    csgm_features features; /* default SHARP */
    bool colors;            /* vertex colours where the scene has any; default true */
    bool prune;             /* default true; false gives the same mesh, slower (for checking) */
    /* The next three thin the mesh out; at most one of them may be given. Every collapse of an
     * edge, and the result, is checked against the field; creases, colours, materials and parts
     * stay, and a mesh in memory is needed where it would have been streamed. */
    double tolerance;      /* > 0: no point of the mesh is farther than this from the surface, nor,
                              as measured on the lattice, the surface from the mesh, whose vertices
                              lie on both sides of it where it is curved; with resolution and
                              cell_size 0 the cells follow the shape; default 0 */
    double simplify_error; /* > 0: the same for the mesh of the resolution given; without one, the
                              tolerance of cells that follow the shape, not proven; default 0 */
    double simplify_share; /* > 0, < 1: so many of the triangles may stay; default 0 */
    bool improve; /* vertices move along the surface and edges flip, for better triangles; default
                     false */
    /* Look for what lies between the lattice's points: csgm_mesh_stats.certify says what is proven,
     * and what is missed is a warning each (W0406, W0407); default false. Without it a scan of
     * samples of equal cells warns once of the thin parts that it happens to see. The mesh is that
     * of equal cells without it. */
    bool certify;
    double certify_size; /* cubes that are not settled are divided down to this; 0 = cell / 64 */
    csgm_monitor monitor;
    /* With resolution and cell_size 0 and no tolerance; default NORMAL. */
    csgm_quality quality;
    /* > 0: at most so many triangles, the cheapest left out first; with resolution and cell_size 0,
     * of the lattice that `quality` says; default 0 */
    uint64_t triangles;
} csgm_mesh_options;

CSGM_API csgm_mesh_options csgm_mesh_options_default(void);

/* The tolerance T of a quality for a solid of these bounds; 0 where they are empty, a point or
 * infinite. Given as simplify_error, with resolution and cell_size 0, it meshes other
 * solids within the same T: two of them that differ in size then differ in the mesh only where they
 * differ in shape. */
CSGM_API double csgm_quality_tolerance(csgm_quality quality, csgm_box bounds);

/* A part of the solid, or a gap in it, that no point of the lattice stands for. */
typedef struct csgm_certify_place {
    bool is_missed; /* false: it could not be told */
    bool is_gap;    /* a crack or bubble; false: a sheet, needle or drop */
    csgm_vec3 at;
    double thickness;        /* of the largest ball found in it; 0 where not missed */
    double cell_size;        /* of a mesh that has it; 0 where not missed */
    uint64_t cells;          /* neighbouring cells that are alike */
    const char *source_name; /* of the text of the solid there; of the scene; NULL = not known */
    uint32_t line, column;   /* 1-based; 0 = not known */
} csgm_certify_place;

enum { CSGM_CERTIFY_PLACES_MOST = 16 };

/* What csgm_mesh_options.certify found: how many of the cells that the surface touches are proven,
 * and where they are not. docs/certify.md has the promise and its proof. */
typedef struct csgm_certify {
    bool is_done;
    uint64_t certified;  /* one smooth sheet: all gradients in it within a cone */
    uint64_t crease;     /* the same, with an edge or corner of the solid */
    uint64_t refined;    /* divided until nothing thicker than `thickness` could hide */
    uint64_t unresolved; /* it could not be told */
    uint64_t missed;     /* a part of it is not in the mesh */
    double thickness;    /* every part of the solid and of the space around it that is thicker is in
                            the mesh, but for the missed and unresolved; 0 = every part */
    uint32_t place_count;
    uint64_t places_more;                                /* beyond those listed */
    csgm_certify_place places[CSGM_CERTIFY_PLACES_MOST]; /* the missed ones first */
} csgm_certify;

enum { CSGM_LEVELS_MOST = 24 }; /* sizes of cells in one mesh: each half as large as the last */

/* What a mesh build did and found: times in seconds of wall time, counts, and distances in scene
 * units. Start from csgm_mesh_stats_default(): members that the caller's struct does not have are
 * left out, and a size that no version has had is CSGM_ERR_ARGUMENT. */
typedef struct csgm_mesh_stats {
    uint32_t struct_size; /* set by csgm_mesh_stats_default; do not touch */
    uint32_t cells[3];    /* of cell_size, along the axes */
    /* Wall time of octree, sampling and counting; of roots, normals and triangles. */
    double octree_s, mesh_s;
    double cell_size;
    uint64_t cells_visited;                 /* octree cells tested */
    uint64_t pruned_outside, pruned_inside; /* of those, proven free of surface */
    uint64_t leaf_blocks;                   /* blocks of 8^3 cells that were sampled */
    uint64_t point_evaluations, gradient_evaluations, interval_evaluations;
    uint64_t primitive_evaluations; /* primitives times points or cells, in all three */
    double mean_tape_length;        /* primitives and operators a sampled block evaluates */
    uint64_t memory_peak_bytes;
    uint64_t feature_vertices; /* places on creases, corners and tips that are vertices */
    uint64_t smooth_features;  /* polygons that a crease runs through without such a vertex: there
                                  it is cut as by plain marching cubes */
    uint64_t fading_features;  /* the same, where the crease is blunter than 12 degrees and ends */
    double reshape_s;          /* wall time of thinning out and improving */
    uint64_t triangles_before; /* that; 0: it was not asked for */
    bool is_measured;          /* the rest is known */
    double distance_allowed;   /* as asked for, or what simplify_share came to */
    double max_distance_bound; /* proven of every point of the mesh: its distance from the surface
                                  is below this; infinite where open_places is not 0 */
    double max_distance_measured; /* largest distance of a sample of the surface from the mesh */
    uint64_t open_places;         /* pieces of triangles of which nothing could be proven */
    uint64_t unresolved_cells;    /* that the scan of samples doubts, or --certify could not tell */
    csgm_certify certify;         /* where csgm_mesh_options.certify asked for it */
    double tolerance;     /* that cells which follow the shape were chosen for; 0: all are equal */
    double cell_coarsest; /* the largest that they may be; cell_size is the finest */
    /* Blocks of 2^3 cells that follow the shape, by the size of these: cell_coarsest / 2^i. */
    uint64_t blocks[CSGM_LEVELS_MOST];
    /* Of polyhedra, which went into the mesh as they are. Where they are all of it, it has no
     * cells: cell_size is 0. */
    uint64_t own_triangles;
    uint64_t own_triangles_before; /* of polyhedra, which thinning out and improving began with */
} csgm_mesh_stats;

/* All zeros but struct_size. */
CSGM_API csgm_mesh_stats csgm_mesh_stats_default(void);

/* options NULL = defaults; stats may be NULL. A scene without a surface in the bounds gives a
 * mesh without triangles and a warning. */
CSGM_API csgm_status csgm_mesh_build(csgm_context *context, const csgm_field *field,
                                     const csgm_mesh_options *options, csgm_mesh **out,
                                     csgm_mesh_stats *stats);
CSGM_API void csgm_mesh_destroy(csgm_mesh *mesh);

/* A run of a mesh's triangles that is an object of its own: a glTF node and mesh, an OBJ object or
 * a 3MF object. Other formats hold all parts one after the other. */
typedef struct csgm_mesh_part {
    const char *name; /* UTF-8; NULL = without a name */
    uint64_t first_triangle, triangle_count;
} csgm_mesh_part;

/* The arrays of a mesh, borrowed: they live as long as the mesh. Fill one yourself to write or
 * compare arrays of your own. */
typedef struct csgm_mesh_view {
    csgm_vec3 origin; /* position i in scene units = origin + positions[3*i..]; zero unless the
                         solid lies so far out that floats would be too coarse */
    const float *positions;  /* 3 * vertex_count */
    const float *normals;    /* 3 * vertex_count, unit length, outward, or NULL */
    const uint8_t *colors;   /* 4 * vertex_count, sRGB + alpha, or NULL */
    const uint32_t *indices; /* 3 * triangle_count; counter-clockwise seen from outside */
    uint64_t vertex_count, triangle_count; /* vertex_count < 2^32 */
    const csgm_mesh_part *parts; /* part_count, all triangles in order; NULL = one without a name */
    uint64_t part_count;
    const uint16_t *materials; /* 2 * vertex_count: metallic and roughness times 10000, or NULL */
    bool split;       /* built with CSGM_NORMALS_CREASE. Formats without CSGM_KEEPS_CREASES join the
                         vertices of one place again, with the mean of their normals */
    bool equal_cells; /* built of one solid with equal cells. glTF then has nothing that needs all
                         of the mesh at once, so that it is the same where csgm_mesh_build_file
                         fills the file while the mesh is made */
} csgm_mesh_view;

CSGM_API csgm_mesh_view csgm_mesh_get_view(const csgm_mesh *mesh);

/* What csgm_mesh_inspect counts and measures. A closed oriented 2-manifold has zeros in the first
 * block. Lengths, areas and volumes are in scene units, their squares and cubes. */
typedef struct csgm_mesh_check {
    uint64_t boundary_edges;       /* used once */
    uint64_t nonmanifold_edges;    /* used more than twice */
    uint64_t misoriented_edges;    /* used twice in the same direction */
    uint64_t nonmanifold_vertices; /* more than one fan of triangles around it */
    uint64_t degenerate_triangles; /* an index used twice */
    uint64_t index_out_of_range;   /* indices >= vertex_count; left out of the rest */

    uint64_t unused_vertices;
    uint64_t zero_area_triangles;
    int64_t euler;       /* V - E + F over used vertices */
    uint64_t components; /* connected by shared edges */
    int64_t genus;       /* components - euler / 2; meaningful for closed manifolds */
    double area, volume; /* volume by the divergence theorem; meaningful for closed meshes */
    double min_angle_deg;
    double max_aspect; /* longest side over smallest altitude: 1.15 at best; 0 = no triangles,
                          infinite where one has no area */
    csgm_box bounds;   /* of used vertices */
} csgm_mesh_check;

CSGM_API csgm_status csgm_mesh_inspect(csgm_context *context, const csgm_mesh_view *mesh,
                                       csgm_mesh_check *out);

/* ---- measures ---------------------------------------------------------------------- */

/* All numbers from low to high; the true one is among them. Infinite ends: nothing is known. */
typedef struct csgm_interval {
    double low, high;
} csgm_interval;

/* How closely, and what of it. */
typedef struct csgm_measure_options {
    uint32_t struct_size; /* set by csgm_measure_options_default; do not touch */
    double tolerance;     /* > 0, default 1e-4: how wide the volume's interval may be, as a share of
                             its upper end; those of the bounds, of the longest side */
    double density;       /* > 0, default 1: mass per cubic scene unit */
    const char *part;     /* of this name alone; NULL (default): all of it */
    uint64_t most_cubes;  /* > 0, default 2^24: of the octree, in all; about a million a second */
    csgm_monitor monitor; /* stage CSGM_STAGE_MEASURE */
} csgm_measure_options;

CSGM_API csgm_measure_options csgm_measure_options_default(void);

/* What a solid measures, each between proven bounds, in scene units. */
typedef struct csgm_measures {
    uint32_t struct_size;       /* set by csgm_measures_default; do not touch */
    bool is_reached;            /* as closely as the tolerance asks */
    uint64_t cubes;             /* looked at; 0 of a mesh */
    csgm_interval volume, mass; /* mass = density * volume */
    csgm_interval centroid[3];  /* x, y, z */
    csgm_interval inertia[6];   /* times density, around the centroid along the axes: I_xx, I_yy,
                                   I_zz, I_xy, I_xz, I_yz, I_xx the integral of y^2 + z^2, I_xy that
                                   of -x y */
    csgm_interval bounds[6];    /* the smallest box: its least x, y, z, then its largest */
    csgm_interval moments[3];   /* principal moments of inertia, the smallest first */
    csgm_vec3 axes[3];     /* their directions, of unit length, the largest component positive */
    double axis_within[3]; /* degrees: the true axis is no farther from it; 90: unknown, as where
                              two moments may be equal */
    csgm_interval area;    /* of the surface; high INFINITY: a field's gradients are not bounded */
} csgm_measures;

/* All zeros but struct_size. */
CSGM_API csgm_measures csgm_measures_default(void);

/* Volume, centroid, inertia and tight bounds of {f >= 0}: an octree whose cubes are inside, outside
 * or cut by planes that the solid is proven to lie between (docs/measure.md). The same for any
 * number of threads. options NULL = defaults. CSGM_ERR_ARGUMENT: an option out of range, or no part
 * has that name (csgm_field_part). CSGM_ERR_SCENE (reported): the solid is empty or unbounded. With
 * CSGM_ERR_LIMIT, CSGM_ERR_MEMORY and CSGM_CANCELLED *out has what is proven by then; else it is
 * written on CSGM_OK only. */
CSGM_API csgm_status csgm_measure_field(csgm_context *context, const csgm_field *field,
                                        const csgm_measure_options *options, csgm_measures *out);

/* The same of a mesh, exact but for rounding, which the intervals include, by the divergence
 * theorem: what its triangles enclose more than once counts as often. CSGM_ERR_FORMAT (reported):
 * it is not closed, edges are shared by more than two triangles, or it is inside out. */
CSGM_API csgm_status csgm_measure_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                                       const csgm_measure_options *options, csgm_measures *out);

/* For drawing a mesh with fewer triangles than it has: the vertices in each cell of a grid over
 * `frame` become one, and cells grow until at most most_triangles have their corners in three of
 * them (or eight cells lie along the longest side). cluster_of gets vertex_count numbers below
 * *cluster_count, in the order of the cells. *cell_size: the edge of a cell; 0: there are few
 * enough triangles, and each vertex is its own cluster. Indices must be in range:
 * CSGM_ERR_ARGUMENT. */
CSGM_API csgm_status csgm_mesh_cluster(csgm_context *context, const csgm_mesh_view *mesh,
                                       csgm_box frame, uint64_t most_triangles,
                                       uint32_t *cluster_of, uint32_t *cluster_count,
                                       double *cell_size);

/* Largest |f| over the mesh's vertices, in double precision (lambda = 1: their distance to the
 * surface is at least this). In a scene of many nodes it looks at evenly spaced vertices only, so
 * that it ends within seconds; *measured (may be NULL) says at how many. */
CSGM_API double csgm_mesh_max_abs_field(const csgm_scene *scene, const csgm_mesh_view *mesh,
                                        uint64_t *measured);

/* ---- files ------------------------------------------------------------------------- */

/* The kinds of mesh files. */
typedef enum csgm_format {
    CSGM_FORMAT_AUTO, /* by the extension */
    CSGM_FORMAT_OBJ,
    CSGM_FORMAT_PLY, /* binary little endian; ASCII with csgm_write_options.ascii */
    CSGM_FORMAT_STL, /* binary; ASCII with csgm_write_options.ascii */
    CSGM_FORMAT_OFF,
    CSGM_FORMAT_GLTF, /* JSON with the buffer embedded as base64 */
    CSGM_FORMAT_GLB,
    CSGM_FORMAT_DRC, /* bare Draco */
    CSGM_FORMAT_3MF, /* a ZIP package of XML */
    CSGM_FORMAT_AMF, /* XML, ISO/ASTM 52915 */
    /* New ones come here. A release may add some, so a program loops from AUTO + 1 and asks each
     * format what it can do; it does not keep COUNT. */
    CSGM_FORMAT_COUNT
} csgm_format;

/* What a format can do, as bits. "Keeps" means that what is in the mesh is in the file and comes
 * back where the format is read. */
typedef enum csgm_format_trait {
    CSGM_IS_WRITTEN = 1 << 0,
    CSGM_IS_READ = 1 << 1,
    CSGM_IS_STREAMED = 1 << 2,    /* csgm_mesh_build_file fills the file while the mesh is made */
    CSGM_IS_TEXT = 1 << 3,        /* with any options */
    CSGM_KEEPS_VERTICES = 1 << 4, /* their number and order; else triangles have their own */
    CSGM_KEEPS_DOUBLES = 1 << 5,  /* coordinates far from zero, as csgm_mesh_view.origin has them */
    CSGM_KEEPS_NORMALS = 1 << 6,  /* those of vertices */
    CSGM_KEEPS_CREASES = 1 << 7,  /* several normals at one point: CSGM_NORMALS_CREASE */
    CSGM_KEEPS_COLORS = 1 << 8,
    CSGM_KEEPS_ALPHA = 1 << 9,      /* the opacity of colours */
    CSGM_KEEPS_NAMES = 1 << 10,     /* parts and what they are called */
    CSGM_KEEPS_MATERIALS = 1 << 11, /* metallic and roughness */
    CSGM_NAMES_FILES = 1 << 12,     /* such a file may say that a part of it is in other files */
    CSGM_HEEDS_ASCII = 1 << 13,     /* the rest are members of csgm_write_options: ascii */
    CSGM_HEEDS_UP = 1 << 14,        /* y_up */
    CSGM_HEEDS_UNIT = 1 << 15,
    CSGM_HEEDS_COMMENT = 1 << 16,
    CSGM_HEEDS_DRACO = 1 << 17,      /* draco; with it draco_*_bits and draco_level */
    CSGM_HEEDS_DRACO_BITS = 1 << 18, /* draco_*_bits and draco_level always */
    CSGM_HEEDS_METADATA = 1 << 19,
    CSGM_HEEDS_MESHOPT = 1 << 20,
    CSGM_HEEDS_UV = 1 << 21,
    CSGM_HEEDS_LEVELS = 1 << 22,
    CSGM_KEEPS_PLAIN_LOOKS = 1 << 23 /* opacity, metallic and roughness of parts that have one of
                                        each, in a file beside the mesh's where it has a name */
} csgm_format_trait;

/* AUTO when the extension (or name, e.g. "ply") is unknown. */
CSGM_API csgm_format csgm_format_from_path(const char *path);
CSGM_API csgm_format csgm_format_from_name(const char *name);
CSGM_API const char *csgm_format_name(csgm_format format);  /* "ply"; static storage */
CSGM_API const char *csgm_format_title(csgm_format format); /* "glTF": its name in a sentence */
/* csgm_format_trait bits; 0 for AUTO and for what is no format. */
CSGM_API uint32_t csgm_format_traits(csgm_format format);
/* Whether this build writes (or reads) the format: it may be written only, or a library may be
 * missing. */
CSGM_API bool csgm_format_available(csgm_format format, bool for_reading);
/* For --version, a line for each library: what it is for, and its version or that this build lacks
 * it. */
CSGM_API const char *csgm_build_features(void);

/* The length of one scene unit, as a file says it. */
typedef enum csgm_unit {
    CSGM_UNIT_NONE,
    CSGM_UNIT_MM,
    CSGM_UNIT_CM,
    CSGM_UNIT_M,
    CSGM_UNIT_IN
} csgm_unit;

/* Texture coordinates, in scene units, for pictures that repeat. */
typedef enum csgm_uv {
    CSGM_UV_NONE,
    CSGM_UV_BOX,     /* each triangle from the side that it faces most */
    CSGM_UV_CYLINDER /* around the Z axis through the middle; caps from above and below */
} csgm_uv;

enum { CSGM_DETAILS_MOST = 8 }; /* levels of detail beside the first one */

/* A coarser mesh of the same solid, for where it is seen from afar. */
typedef struct csgm_level {
    csgm_mesh_view mesh;
    /* In scene units; the file says all three. */
    double error;    /* within which it is of the solid: proven, or else what was asked for */
    double measured; /* the largest distance of a sample of the solid's surface from it */
    bool is_proven;
} csgm_level;

/* How a mesh file is written. A format ignores what it has no place for. */
typedef struct csgm_write_options {
    uint32_t struct_size;         /* set by csgm_write_options_default; do not touch */
    bool ascii;                   /* PLY and STL as text; default false */
    bool draco;                   /* GLB and glTF with KHR_draco_mesh_compression; default false */
    uint32_t draco_position_bits; /* 1..30, default 14 */
    uint32_t draco_normal_bits;   /* 2..30, default 10 */
    uint32_t draco_color_bits;    /* 1..30, default 8 */
    uint32_t draco_level;         /* 0 (fast) .. 10 (small), default 7 */
    bool y_up; /* glTF and GLB: one node rotates Z up to glTF's Y up; default true.
                  Other formats keep the scene's axes. */
    bool sync; /* the bytes are on the disk before the file gets its name, so that a power cut
                  leaves the old file or the new one; default true */
    bool only_if_changed; /* a file that holds these bytes already is left alone, with its time of
                             change; default false */
    csgm_unit unit; /* what a scene unit is; default MM. glTF and GLB: one node scales it to metres,
                       not at all where it is NONE; 3MF and AMF: the file says it, millimetres
                       where it is NONE */
    const char *comment; /* one line of up to 255 bytes for PLY's header and the extras of glTF's
                            asset; other formats leave it out; NULL (default) = none */
    const char *const *metadata; /* metadata_count times "KEY=VALUE", such as "title=Mug"; title,
                                    author, license, source and version have places of their own
                                    where a format has such. The last one of a key counts. Formats
                                    without CSGM_HEEDS_METADATA leave them out */
    size_t metadata_count;
    bool meshopt; /* GLB and glTF: positions quantised (KHR_mesh_quantization), all compressed by
                     EXT_meshopt_compression; default false. Not together with draco */
    bool meshopt_khr; /* then by KHR_meshopt_compression, its successor, which takes less and which
                         fewer programs read yet; default false */
    csgm_uv uv;       /* GLB and glTF; default NONE */
    const csgm_level *levels; /* level_count of them, each coarser than the one before: further
                                 levels of detail in GLB and glTF (MSFT_lod) */
    size_t level_count;       /* default 0, at most CSGM_DETAILS_MOST */
} csgm_write_options;

CSGM_API csgm_write_options csgm_write_options_default(void);

/* What the outlines of a flat scene are written as. */
typedef enum csgm_drawing_format {
    CSGM_DRAWING_NONE,
    CSGM_DRAWING_SVG,
    CSGM_DRAWING_DXF,
    CSGM_DRAWING_PDF,
    CSGM_DRAWING_COUNT
} csgm_drawing_format;

CSGM_API csgm_drawing_format csgm_drawing_format_from_path(const char *path);
CSGM_API csgm_drawing_format csgm_drawing_format_from_name(const char *name);
CSGM_API const char *csgm_drawing_format_name(csgm_drawing_format format);
/* Whether this build draws: Clipper may be missing. */
CSGM_API bool csgm_drawing_format_available(csgm_drawing_format format);
/* How many layers the drawing of a scene has: one for each part's name and colour. 0: nothing
 * encloses an area, or no drawing was asked for (csgm_flat). */
CSGM_API size_t csgm_scene_layer_count(const csgm_scene *scene);
/* Writes the drawing, in millimetres: corners as they are, arcs within 1e-5 of the figure's size,
 * what is blended or a formula along its contour on a lattice of 512 cells. As csgm_mesh_write; of
 * the options unit, sync and only_if_changed count. CSGM_ERR_ARGUMENT: it has no layers. */
CSGM_API csgm_status csgm_scene_draw(csgm_context *context, const csgm_scene *scene,
                                     const char *path, csgm_drawing_format format,
                                     const csgm_write_options *options);
CSGM_API csgm_status csgm_scene_draw_fd(csgm_context *context, const csgm_scene *scene, int fd,
                                        const char *name, csgm_drawing_format format,
                                        const csgm_write_options *options);

/* The file appears complete or not at all: written beside the target, synced, renamed.
 * options NULL = defaults. */
CSGM_API csgm_status csgm_mesh_write(csgm_context *context, const csgm_mesh_view *mesh,
                                     const char *path, csgm_format format,
                                     const csgm_write_options *options);
/* The same bytes to an open file descriptor (a pipe, standard output). */
CSGM_API csgm_status csgm_mesh_write_fd(csgm_context *context, const csgm_mesh_view *mesh, int fd,
                                        const char *name, csgm_format format,
                                        const csgm_write_options *options);
/* From csgm_files_hold on, files that calls with this context write are complete on the disk and
 * wait for their names: until csgm_files_release gives all of them theirs, in the order in which
 * they were written (keep), or removes them; so does csgm_context_destroy. Pipes and devices are
 * written at once. Where one cannot have its name, it and those after it are removed, and that is
 * the status. */
CSGM_API csgm_status csgm_files_hold(csgm_context *context);
CSGM_API csgm_status csgm_files_release(csgm_context *context, bool keep);
/* Any other file that appears as these do: complete, or not at all, held where files are held.
 * context NULL: failures are not reported, errno says what it was; memory is malloc's. */
typedef struct csgm_file csgm_file;
CSGM_API csgm_status csgm_file_create(csgm_context *context, const char *path, csgm_file **out);
CSGM_API int csgm_file_descriptor(const csgm_file *file); /* to write to; do not close it */
/* Gives it its name (keep; sync: once it is on the disk), or removes it, and ends the handle. */
CSGM_API csgm_status csgm_file_end(csgm_file *file, bool keep, bool sync);
/* Removes what killed processes have left in a folder: files that csgmesh has put there before they
 * had their names, and that no process has open. Where the file system can have files without a
 * name there are none; writing in a folder does it, too, once in a process. */
CSGM_API void csgm_files_sweep(const char *folder);
/* Removes what unfinished csgm_mesh_write calls have put beside their targets. Async-signal-safe:
 * for a handler that then ends the process with _exit. */
CSGM_API void csgm_files_abandon(void);
/* csgm_mesh_build and csgm_mesh_write in one, the same bytes. Binary PLY and STL and plain GLB are
 * filled while the mesh is made, by all threads, in memory of the surface's blocks and not of the
 * mesh; any other format (and a pipe or device) keeps the mesh in memory until it is written. A
 * mesh without triangles writes no file: CSGM_ERR_SCENE, after a warning. counts (vertices,
 * triangles) and stats may be NULL; options NULL = defaults. */
CSGM_API csgm_status csgm_mesh_build_file(csgm_context *context, const csgm_field *field,
                                          const csgm_mesh_options *options, const char *path,
                                          csgm_format format,
                                          const csgm_write_options *write_options,
                                          uint64_t counts[2], csgm_mesh_stats *stats);

/* A glTF's node transforms are applied and the Z-up frame restored; several meshes are joined.
 * STL corners with equal position bits become one vertex. */
CSGM_API csgm_status csgm_mesh_read(csgm_context *context, const char *path, csgm_format format,
                                    csgm_mesh **out);

/* What is in a mesh file, as csgm_mesh_read and csgm_mesh_inspect would find it. */
typedef struct csgm_file_figures {
    uint32_t struct_size; /* set by csgm_file_figures_default; do not touch */
    bool has_normals, has_colors;
    uint64_t vertices, triangles;
    csgm_mesh_check check;
} csgm_file_figures;

/* All zeros but struct_size. */
CSGM_API csgm_file_figures csgm_file_figures_default(void);

/* Where the limit of memory is too narrow to read it, a binary STL or PLY is gone through several
 * times, in runs: then four bytes for each triangle and a few MB are enough. */
CSGM_API csgm_status csgm_mesh_file_inspect(csgm_context *context, const char *path,
                                            csgm_format format, csgm_file_figures *out);

/* The mesh as a file of this format gives it back: rounded, welded or split, and without what the
 * format does not keep. */
CSGM_API csgm_status csgm_mesh_as_file(csgm_context *context, const csgm_mesh_view *mesh,
                                       csgm_format format, const csgm_write_options *options,
                                       csgm_mesh **out);

/* ---- pictures ---------------------------------------------------------------------- */

/* A picture in memory. It is drawn by the processor alone, without a display or graphics card, and
 * has the same bytes for any number of threads and any instruction set. */
typedef struct csgm_image csgm_image;

/* The pixels of an image, borrowed: they live as long as the image. */
typedef struct csgm_image_view {
    uint32_t width, height;
    const uint8_t *pixels; /* 4 * width * height, rows from the top: sRGB, alpha (not multiplied) */
} csgm_image_view;

/* The formats that pictures are written in. */
typedef enum csgm_image_format {
    CSGM_IMAGE_AUTO, /* by the extension */
    CSGM_IMAGE_PNG,
    CSGM_IMAGE_PPM, /* binary (P6): no alpha, what is transparent is laid over white */
    CSGM_IMAGE_FORMAT_COUNT
} csgm_image_format;

CSGM_API csgm_image_format csgm_image_format_from_path(const char *path);
CSGM_API bool csgm_image_format_available(csgm_image_format format);
/* The same pixels, copied. */
CSGM_API csgm_status csgm_image_create(csgm_context *context, const csgm_image_view *view,
                                       csgm_image **out);
CSGM_API csgm_image_view csgm_image_get_view(const csgm_image *image);
CSGM_API void csgm_image_destroy(csgm_image *image);
/* As csgm_mesh_write: the file appears complete or not at all. */
CSGM_API csgm_status csgm_image_write(csgm_context *context, const csgm_image *image,
                                      const char *path, csgm_image_format format);
CSGM_API csgm_status csgm_image_write_fd(csgm_context *context, const csgm_image *image, int fd,
                                         const char *name, csgm_image_format format);

/* How the camera projects: as the eye sees, or with parallel lines staying parallel. */
typedef enum csgm_projection { CSGM_PERSPECTIVE, CSGM_ORTHOGRAPHIC } csgm_projection;

/* Where a picture is taken from. Angles are in degrees, lengths in scene units. */
typedef struct csgm_camera {
    csgm_projection projection; /* default PERSPECTIVE */
    double fov_deg;             /* perspective: vertical angle of view, 1 .. 150; default 30 */
    /* Not placed (the default): looks at the middle of the bounds from there, from so far away that
     * all of them are seen. azimuth: 0 from -y (the front), 90 from +x (the right), within 1e6. */
    double azimuth_deg, elevation_deg; /* default 35 and 25; elevation -90 .. 90 */
    bool placed;
    csgm_vec3 eye, target, up; /* when placed; up default (0, 0, 1) */
    double height; /* orthographic: scene units that the picture is high; default 0 = all of the
                      bounds */
    double zoom;   /* makes things so much larger; default 1 */
} csgm_camera;

/* Which evaluator draws a scene. */
typedef enum csgm_evaluator {
    CSGM_EVALUATOR_FAST, /* float kernels over batches, tapes pruned for each cell of an octree */
    CSGM_EVALUATOR_LAZY  /* double, point by point, lazy evaluation with S-bounds: for counting */
} csgm_evaluator;

/* How a picture is drawn: its size, the camera, light, and sections. */
typedef struct csgm_render_options {
    uint32_t struct_size;   /* set by csgm_render_options_default; do not touch */
    uint32_t width, height; /* pixels, 1 .. 16384 each; default 1280 x 960 */
    uint32_t samples; /* n: n x n rays per pixel where neighbours differ, 1 .. 8; default 3; a mesh
                         is drawn with n x n samples everywhere */
    csgm_camera camera;
    csgm_box frame; /* what the camera is placed by; empty (the default) = what is drawn */
    bool turns; /* the camera stands so far away that what it frames fits from any azimuth; default
                   false */
    uint8_t background[4]; /* sRGB and alpha; default white, opaque */
    bool occlusion;  /* ambient occlusion, from the field; of a mesh on the ground; default true */
    bool shadows;    /* soft shadows of the key light; of a mesh on the ground; default true */
    csgm_box bounds; /* a scene is cut there; empty (the default) = the scene's own */

    int slice_axis; /* -1 (the default): none; 0, 1, 2: the section x, y or z = slice_at is
                       drawn, with iso-lines of f, instead of the solid */
    double slice_at;
    double iso_step; /* between iso-lines; default 0 = chosen, about twenty */

    bool wireframe; /* a mesh: its edges too; default false */
    bool flat;      /* a mesh: each triangle by its own normal; default false = vertex normals
                       where the mesh has any */

    csgm_evaluator evaluator; /* default FAST */
    bool lazy, bounds_used;   /* LAZY: lazy operators and S-bounds; default true; for comparison */
    csgm_monitor monitor;     /* stage CSGM_STAGE_RENDER */

    bool ground; /* the shadow on a plane below the lowest place, where the eye is above it; needs
                    shadows or occlusion; default true */
    bool edges;  /* dark lines along outlines and creases; not of sections, nor by the evaluator
                    LAZY; default false */
} csgm_render_options;

CSGM_API csgm_render_options csgm_render_options_default(void);

/* What a picture cost: times in seconds of wall time, and counts. */
typedef struct csgm_render_stats {
    double prepare_s, trace_s; /* wall time of the octree; of the picture */
    uint64_t cells;            /* of the octree: those that the surface may touch */
    uint64_t rays, shadow_rays, hits;
    uint64_t point_evaluations, gradient_evaluations, interval_evaluations;
    uint64_t primitive_evaluations; /* primitives times points or cells, in all three */
    uint64_t top_level_evaluations; /* LAZY: of the whole field */
    uint64_t total_evaluations;     /* LAZY: of nodes of the tree */
    uint64_t memory_peak_bytes;
} csgm_render_stats;

/* The field's surface, by sphere tracing, and over it translucently what # and % stand before in
 * the scene. options NULL = defaults; stats may be NULL. A scene without a surface gives the
 * background and a warning. */
CSGM_API csgm_status csgm_render_scene(csgm_context *context, const csgm_field *field,
                                       const csgm_render_options *options, csgm_image **out,
                                       csgm_render_stats *stats);
/* Triangles, by a z-buffer; both sides are drawn. Options of scenes have no effect. */
CSGM_API csgm_status csgm_render_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                                      const csgm_render_options *options, csgm_image **out,
                                      csgm_render_stats *stats);

/* ---- JSON: the reader that this library uses itself ----------------------------------- */

/* What csgm_json_read meets, in the order of the text. */
typedef enum csgm_json_kind {
    CSGM_JSON_OBJECT, /* '{' */
    CSGM_JSON_ARRAY,  /* '[' */
    CSGM_JSON_END,    /* of the innermost of both */
    CSGM_JSON_KEY,
    CSGM_JSON_STRING,
    CSGM_JSON_NUMBER, /* as it is written */
    CSGM_JSON_WORD    /* true, false, null */
} csgm_json_kind;

/* text: of KEY, STRING (unescaped), NUMBER and WORD; borrowed, may hold NULs, not terminated.
 * false = stop, which is no failure. */
typedef bool csgm_json_fn(void *user, csgm_json_kind kind, const char *text, size_t length);

/* name: for diagnostics. CSGM_ERR_SYNTAX: not JSON, with the place; CSGM_ERR_UNSUPPORTED: a build
 * without its library. What was read before an error has been told. */
CSGM_API csgm_status csgm_json_read(csgm_context *context, const char *text, size_t text_length,
                                    const char *name, csgm_json_fn *event, void *user);

/* ---- looking inside the mesher ---------------------------------------------------------- */

/* From begin to end a context keeps what the meshes built in it are made from. end hands it over as
 * a mesh in scene coordinates for any viewer, with up to three parts: "octree", the cubes it ended
 * in, and "blocks", of 8^3 equal cells or the single cells that follow the shape, both as frames,
 * from blue to yellow by how much of the scene counts in them; "features" of equal cells, cubes
 * where creases and corners have a vertex (green), are folded (orange), given up (red), or are kept
 * without (grey). It has no triangles where nothing had cells: such as of polyhedra that went into
 * the mesh as they are. CSGM_ERR_ARGUMENT: begun twice, or ended without a beginning. */
CSGM_API csgm_status csgm_survey_begin(csgm_context *context);
CSGM_API csgm_status csgm_survey_end(csgm_context *context, csgm_mesh **out);

/* ---- looking inside (stable text, for tests and for people) -------------------------- */

/* What csgm_scene_dump shows. */
typedef enum csgm_dump {
    CSGM_DUMP_SCENE,
    CSGM_DUMP_TAPE,
    CSGM_DUMP_VM,
    CSGM_DUMP_OPENSCAD
} csgm_dump;

/* SCENE parses back to the same tree. VM is the scene's formula as the programs fidget and libfive
 * read it, negative inside; CSGM_ERR_UNSUPPORTED: no formula is known for one of its solids.
 * OPENSCAD is text that OpenSCAD reads, as its .csg files; CSGM_ERR_UNSUPPORTED: it has no words
 * for one of the solids (blends, formulas ...). Load the scene with CSGM_FACETS_EXACT, and with
 * CSGM_FLAT_KEPT. */
CSGM_API csgm_status csgm_scene_dump(csgm_context *context, const csgm_scene *scene, csgm_dump what,
                                     csgm_text_fn *sink, void *user);

/* ---- diff: how far two meshes are apart ------------------------------------------------ */

/* A is what was (the golden), B what is. Corners at one place are one vertex, whatever the files
 * say. Everything below is the same for any number of threads. */
typedef enum csgm_diff_level {
    CSGM_DIFF_NOT_EQUAL,        /* more than the tolerance apart, or nothing else settled it */
    CSGM_DIFF_WITHIN_TOLERANCE, /* proven */
    CSGM_DIFF_SAME_TRIANGLES,   /* the same triangles of the same points; their order aside */
    CSGM_DIFF_SAME_BYTES /* set by callers that compared files; csgm_diff_meshes never does */
} csgm_diff_level;

/* Why two meshes count as different. */
typedef enum csgm_diff_reason {
    CSGM_DIFF_REASON_DISTANCE = 1,
    CSGM_DIFF_REASON_VOLUME = 2,   /* over tolerance_volume, or it could not be measured */
    CSGM_DIFF_REASON_TOPOLOGY = 4, /* components, genus, open or closed */
    CSGM_DIFF_REASON_NORMALS = 8,  /* looked at where the triangles are the same */
    CSGM_DIFF_REASON_COLORS = 16,  /* and materials */
    CSGM_DIFF_REASON_NAMES = 32,   /* of parts */
    CSGM_DIFF_REASON_EMPTY = 64    /* one has no triangles, the other has */
} csgm_diff_reason;

/* What a comparison does not look at. */
typedef enum csgm_diff_ignored {
    CSGM_DIFF_IGNORE_ORDER = 1, /* of parts; that of vertices and triangles is never looked at */
    CSGM_DIFF_IGNORE_NORMALS = 2,
    CSGM_DIFF_IGNORE_COLORS = 4,
    CSGM_DIFF_IGNORE_NAMES = 8,
    CSGM_DIFF_IGNORE_UP = 16, /* B is also tried with Y up turned to Z up, and the reverse */
    CSGM_DIFF_IGNORE_TOPOLOGY = 32
} csgm_diff_ignored;

/* Whether only added or only removed material counts as a difference. */
typedef enum csgm_diff_material {
    CSGM_DIFF_ANY_MATERIAL,
    CSGM_DIFF_ADDED, /* only what B has and A has not counts, from 1/1000 of the largest distance */
    CSGM_DIFF_REMOVED /* only what A has and B has not */
} csgm_diff_material;

/* What a comparison looks at, and when two meshes count as different. Distances are in scene units.
 */
typedef struct csgm_diff_options {
    uint32_t struct_size; /* set by csgm_diff_options_default; do not touch */
    /* The larger of both counts; relative to the diagonal of A's bounds. 0: the same up to the
     * rounding of coordinates to single precision. Infinite: distance does not matter. */
    double tolerance, tolerance_relative;
    double tolerance_volume;     /* (only in A + only in B) / union; infinite (default): any */
    csgm_diff_material material; /* counts; both meshes must be closed, else everything counts */
    uint32_t ignored;            /* csgm_diff_ignored, or'ed; default 0 */
    uint64_t samples;            /* on each surface, and rays for volumes; default 262144 */
    bool verdict_only;           /* stop when level and reasons are settled: what was not measured
                                    by then says so; default false */
    const csgm_scene *scene_a, *scene_b; /* whose mesh the side is: the other side is measured
                                            against its field too; NULL (default) = not */
    csgm_monitor monitor;                /* stage CSGM_STAGE_COMPARE */
} csgm_diff_options;

CSGM_API csgm_diff_options csgm_diff_options_default(void);

/* What is known of one of the two meshes by itself. */
typedef struct csgm_diff_figures {
    uint64_t vertices, triangles; /* as in the view */
    csgm_mesh_check check;        /* with corners at one place made one vertex */
    bool is_closed;               /* every edge as often in one direction as in the other */
    bool has_normals, has_colors;
    uint64_t parts;
} csgm_diff_figures;

/* A point of one surface and the nearest point of the other, in scene units. */
typedef struct csgm_diff_place {
    csgm_vec3 at, nearest; /* on this surface, on the other */
    double distance;
} csgm_diff_place;

enum { CSGM_DIFF_WORST_MOST = 8 };

/* The distances from all points of one surface to the nearest points of the other: the largest
 * between two proven bounds, and the mean and percentiles of samples. In scene units. */
typedef struct csgm_diff_distance {
    bool is_measured;
    double lower, upper; /* proven: the maximum lies between; upper is within 1 % of lower unless
                            it is within the tolerance or is_refined is false */
    bool is_refined;     /* false: stopped before, by verdict_only or the limit of work */
    csgm_diff_place worst[CSGM_DIFF_WORST_MOST]; /* the first is where lower was found; the others
                              are apart from each other by 5 % of the bounds' diagonal or more */
    uint32_t worst_count;
    bool is_sampled; /* the rest, by points evenly spread over the area */
    double mean, rms, percentile_95, percentile_99;
} csgm_diff_distance;

/* The volumes that only one of two closed meshes encloses, in cubic scene units. */
typedef struct csgm_diff_volume {
    bool is_measured; /* both are closed */
    double only_a, only_b, both;
    double ratio;    /* (only_a + only_b) / (only_a + only_b + both); 0 when all are 0 */
    double accuracy; /* of only_a and only_b: two standard errors of the rays; an estimate */
} csgm_diff_volume;

/* A mesh against the field f of a scene, f = 0 on the scene's surface, lambda its Lipschitz
 * constant: |f(p)| / lambda <= distance of p, and where f changes sign between p and q, distance
 * <= |p - q|. */
typedef struct csgm_diff_field {
    bool is_measured;
    double lipschitz, max_abs_field, mean_abs_field;
    double lower, upper; /* proven, of the largest distance of a point of the mesh from the scene's
                            surface; upper is infinite where no change of sign was found */
    csgm_vec3 at;        /* where max_abs_field is */
    uint64_t evaluations;
} csgm_diff_field;

/* How much normals, colours or names of parts differ where the triangles are the same. */
typedef struct csgm_diff_attribute {
    bool is_compared;
    double largest; /* normals: degrees; colours: channels 0..255; names: how many differ */
    double share;   /* of the corners (of the area, where triangles differ) that differ: normals by
                       more than 1 degree, colours by more than 1 (16) of 255 */
} csgm_diff_attribute;

/* The whole result of a comparison: the verdict, its reasons, and every figure that was measured.
 */
typedef struct csgm_diff_report {
    csgm_diff_level level;
    bool is_different;
    uint32_t reasons; /* csgm_diff_reason, or'ed; 0 when not different */
    double tolerance; /* that was applied to the distance, with `precision` */
    double precision; /* 2^-23 of the largest coordinate: what single precision may hide */
    csgm_diff_figures figures[2];            /* 0: A, 1: B; also below */
    csgm_diff_distance distance[2];          /* 0: from A to B */
    double hausdorff_lower, hausdorff_upper; /* the larger of both directions */
    csgm_diff_distance counted; /* material ADDED or REMOVED: what decided; only lower, upper,
                                   is_refined and worst[0] are filled */
    csgm_diff_volume volume;
    csgm_diff_field field[2]; /* 0: A's mesh against scene_b */
    csgm_diff_attribute normals, colors, names;
    bool is_turned; /* IGNORE_UP: B was turned to fit; its places are given as turned */
    int turn;       /* how: 1 is (x, y, z) -> (x, -z, y), 2 (x, z, -y); 0: not turned */
} csgm_diff_report;

/* A finished comparison, which holds the report and the distance of each vertex. */
typedef struct csgm_diff csgm_diff;

/* The views must stay until the diff is destroyed. Positions must be finite and indices in range:
 * CSGM_ERR_ARGUMENT, reported. options NULL = defaults. */
CSGM_API csgm_status csgm_diff_meshes(csgm_context *context, const csgm_mesh_view *a,
                                      const csgm_mesh_view *b, const csgm_diff_options *options,
                                      csgm_diff **out);
CSGM_API void csgm_diff_destroy(csgm_diff *diff);
CSGM_API const csgm_diff_report *csgm_diff_get_report(const csgm_diff *diff);
/* Distance of each vertex of one side's view from the other surface, vertex_count floats; side 0 is
 * A. NULL when they were not measured: verdict_only, or a side without triangles. */
CSGM_API const float *csgm_diff_vertex_distances(const csgm_diff *diff, int side);
/* The colour of a distance in heat maps, sRGB: grey where it is 0, then yellow and red to the dark
 * red of `most`. */
CSGM_API void csgm_diff_color(double distance, double most, uint8_t rgb[3]);
/* Writes one side with its distances as vertex colours, PLY, OBJ, OFF or glTF; the scale goes to
 * the comment of PLY and the extras of glTF's asset. CSGM_ERR_ARGUMENT: no distances. */
CSGM_API csgm_status csgm_diff_write_heatmap(csgm_context *context, const csgm_diff *diff, int side,
                                             const char *path, csgm_format format,
                                             const csgm_write_options *options);

#ifdef __cplusplus
}
#endif
#endif /* CSGMESH_CSGMESH_H */
