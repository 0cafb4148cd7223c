/* SPDX-License-Identifier: MIT
 *
 * One mesh made by several processes, the ranks of a communicator as MPI has them. The library
 * knows no MPI: whoever calls it says how ranks exchange bytes (tools/csgmesh/ranks/ does by MPI).
 * The conventions are those of csgmesh.h.
 */
#ifndef CSGMESH_RANKS_H
#define CSGMESH_RANKS_H

#include "csgmesh/csgmesh.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    CSGM_RANKS_MOST = 65536,
    CSGM_ALL_RANKS = 0x7fffffff /* csgm_communicator.gather: to every rank */
};

/* How ranks exchange bytes. All have one byte order and one build of the library. */
typedef struct csgm_communicator {
    uint32_t struct_size; /* set by csgm_communicator_default; do not touch */
    uint32_t rank;        /* < count */
    uint32_t count;       /* of ranks, 1 to CSGM_RANKS_MOST */
    /* Brings bytes[i] bytes of each rank i, those of the caller at `own`, to rank `to`, or to every
     * one (CSGM_ALL_RANKS): one after the other in the order of ranks at `all`, which is NULL where
     * nothing arrives. All ranks call it in the same order with the same `to` and `bytes`, on the
     * thread that called the library. false: the exchange failed, and the call that needed it ends
     * with CSGM_ERR_IO. */
    bool (*gather)(void *user, uint32_t to, const void *own, const uint64_t *bytes, void *all);
    void *user; /* for gather */
} csgm_communicator;

/* One rank alone, without gather. */
CSGM_API csgm_communicator csgm_communicator_default(void);

/* From now on csgm_mesh_build and csgm_mesh_build_file of this context are done by all ranks
 * together: each calls them with the same field, options and path, and gets the same status; what
 * ended the work is reported on the ranks where it happened. The file has the bytes that one
 * process writes; rank 0 gives it its name. Of csgm_mesh_build rank 0 gets the mesh, the others one
 * without triangles. Of cells of one size PLY, STL and GLB of scenes without parts and materials
 * are written by all ranks at their final places, so that none has all of the mesh in memory; all
 * of them must see the file's folder. What else is made of such cells is gathered on rank 0 first.
 * Where cells follow the shape, or the mesh is thinned out or improved, each rank has all of it in
 * memory, the work is shared out, and rank 0 writes. Limits of time and memory are each rank's
 * own. Warnings are reported on rank 0 only.
 *
 * The communicator is copied. NULL: this process is alone again. CSGM_ERR_ARGUMENT: a rank out of
 * range, or several without gather. */
CSGM_API csgm_status csgm_context_join(csgm_context *context,
                                       const csgm_communicator *communicator);

/* From now on csgm_mesh_build_file of this context keeps what is finished in a folder that exists,
 * beside the output and on its file system, and takes from there what an earlier job has finished
 * that was stopped: the file of the mesh, under the name `mesh`, and for each rank what it has
 * counted and made, `rank-0` and so on. The file has the bytes of a job that was not stopped. What
 * is kept is of this build, of as many ranks with as many threads, and of one field: another one's
 * is begun anew; that path, format and options are the same is the caller's care. Where a mesh
 * cannot be filled by all ranks (see above) it is refused (CSGM_ERR_UNSUPPORTED, reported). Once
 * the file has its name the rest can go; that, too, is the caller's. NULL: nothing is kept.
 * CSGM_ERR_ARGUMENT: this process is alone. All ranks call it alike. */
CSGM_API csgm_status csgm_context_keep(csgm_context *context, const char *folder);

/* What this rank has done in the last csgm_mesh_build or csgm_mesh_build_file since it joined. */
typedef struct csgm_rank_work {
    uint32_t struct_size;         /* set by csgm_rank_work_default; do not touch */
    uint64_t cubes;               /* of the octree's frontier that are this rank's */
    uint64_t halo_cubes;          /* those of other ranks that it sampled, too */
    uint64_t vertices, triangles; /* that it made */
    uint64_t received_bytes;      /* from other ranks */
    bool shared_again;      /* the frontier, by what was counted: all ranks have sampled twice */
    uint64_t resumed_cubes; /* counted, and made, by a job before this one: csgm_context_keep */
    /* Items of loops that are shared out, of meshes that all ranks have: some bricks of cells, a
     * cube of space in which triangles are thinned out. Vertices and triangles are then those that
     * it made of cells, before they were thinned out, and as often as cells were divided again. */
    uint64_t tasks;
} csgm_rank_work;

/* All zeros but struct_size. */
CSGM_API csgm_rank_work csgm_rank_work_default(void);
CSGM_API csgm_status csgm_context_rank_work(const csgm_context *context, csgm_rank_work *out);

#ifdef __cplusplus
}
#endif

#endif
