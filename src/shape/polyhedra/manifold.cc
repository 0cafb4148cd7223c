/* SPDX-License-Identifier: MIT
 * Booleans by the Manifold library (E. Lalish and others): symbolic perturbation decides where
 * operands touch, so that the result is a manifold whatever rounding does. It works in doubles on
 * one thread here. What it throws becomes a status.
 */
#include "shape/polyhedra/manifold.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <stdexcept>
#include <thread>
#include <vector>

#include <manifold/manifold.h>

namespace
{

using manifold::Manifold;

/* Asks now and then whether anybody still waits, on a thread of its own. */
class Watcher
{
  public:
    Watcher(const csg_manifold_caller *caller, manifold::ExecutionContext context)
        : caller_(caller), context_(std::move(context)), thread_([this] { ask(); })
    {
    }
    ~Watcher()
    {
        {
            std::lock_guard<std::mutex> lock(mutex_);
            done_ = true;
        }
        wake_.notify_one();
        thread_.join();
    }

  private:
    void ask()
    {
        std::unique_lock<std::mutex> lock(mutex_);
        while (!wake_.wait_for(lock, std::chrono::milliseconds(20), [this] { return done_; }))
            if (caller_->should_stop(caller_->user))
                context_.Cancel();
    }

    const csg_manifold_caller *caller_;
    manifold::ExecutionContext context_;
    std::mutex mutex_;
    std::condition_variable wake_;
    bool done_ = false;
    std::thread thread_; /* last: it uses the others */
};

manifold::MeshGL64 mesh_of(const csg_manifold_step *steps, size_t leaf, double tolerance,
                           const csg_manifold_caller *caller)
{
    manifold::MeshGL64 mesh;
    mesh.tolerance = tolerance;
    mesh.vertProperties.reserve(3 * steps[leaf].point_count);
    mesh.triVerts.reserve(3 * steps[leaf].triangle_count);
    for (size_t i = 0; i < steps[leaf].point_count; i++) {
        double at[3];
        caller->give_point(caller->user, leaf, i, at);
        mesh.vertProperties.insert(mesh.vertProperties.end(), at, at + 3);
    }
    for (size_t i = 0; i < steps[leaf].triangle_count; i++) {
        uint32_t corners[3];
        caller->give_triangle(caller->user, leaf, i, corners);
        mesh.triVerts.insert(mesh.triVerts.end(), corners, corners + 3);
    }
    mesh.faceID.assign(steps[leaf].triangle_count, steps[leaf].mark);
    return mesh;
}

Manifold combined(const csg_manifold_step *step, const std::vector<Manifold> &results)
{
    static const manifold::OpType OPERATIONS[] = {
        manifold::OpType::Add, /* a leaf has none */
        manifold::OpType::Add, manifold::OpType::Intersect, manifold::OpType::Subtract};
    std::vector<Manifold> operands;
    for (uint32_t i = 0; i < step->count; i++)
        operands.push_back(results[step->operands[i]]);
    return Manifold::BatchBoolean(operands, OPERATIONS[step->kind]);
}

csgm_status status_of(Manifold::Error error)
{
    switch (error) {
    case Manifold::Error::NoError:
        return CSGM_OK;
    case Manifold::Error::Cancelled:
        return CSGM_CANCELLED;
    default:
        return CSGM_ERR_SCENE;
    }
}

/* A mesh without its past: which triangles lie in one plane is looked up anew, and of those that do
 * only such of one mark may become one. */
template <class Mesh> Mesh anew(const Mesh &mesh)
{
    Mesh result;
    result.tolerance = mesh.tolerance;
    result.vertProperties = mesh.vertProperties;
    result.triVerts = mesh.triVerts;
    result.faceID = mesh.faceID;
    return result;
}

csgm_status hand_over(const Manifold &result, const csg_manifold_caller *caller)
{
    const manifold::MeshGL mesh = result.GetMeshGL();
    for (size_t i = 0; i < mesh.NumVert(); i++) {
        const auto of = mesh.GetVertPos(i);
        const double at[] = {of.x, of.y, of.z};
        if (!caller->take_point(caller->user, at))
            return CSGM_ERR_MEMORY;
    }
    for (size_t t = 0; t < mesh.NumTri(); t++) {
        const auto of = mesh.GetTriVerts(t);
        const uint32_t corners[] = {static_cast<uint32_t>(of[0]), static_cast<uint32_t>(of[1]),
                                    static_cast<uint32_t>(of[2])};
        if (!caller->take_triangle(caller->user, corners, mesh.faceID[t]))
            return CSGM_ERR_MEMORY;
    }
    return CSGM_OK;
}

csgm_status combine(const csg_manifold_step *steps, size_t count, double tolerance,
                    const csg_manifold_caller *caller)
{
    manifold::ExecutionContext context;
    Watcher watcher(caller, context);
    std::vector<Manifold> results;
    results.reserve(count);
    for (size_t i = 0; i < count; i++) {
        if (steps[i].kind != CSG_BOOLEAN_LEAF) {
            results.push_back(combined(&steps[i], results));
            continue;
        }
        results.push_back(context.FromMeshGL(mesh_of(steps, i, tolerance, caller)));
        const csgm_status status = status_of(results.back().Status());
        if (status != CSGM_OK)
            return status;
    }
    csgm_status status = status_of(results.back().WithContext(context).Status());
    if (status != CSGM_OK)
        return status;
    /* Places become floats, and what is too thin for floats is mended. */
    const Manifold whole = context.FromMeshGL(anew(results.back().GetMeshGL64())).Simplify();
    const Manifold rounded = context.FromMeshGL(anew(whole.GetMeshGL())).Simplify();
    status = status_of(rounded.WithContext(context).Status());
    return status == CSGM_OK ? hand_over(rounded, caller) : status;
}

} // namespace

csgm_status csg_manifold_run(const csg_manifold_step *steps, size_t count, double tolerance,
                             const csg_manifold_caller *caller)
{
    try {
        return combine(steps, count, tolerance, caller);
    } catch (const std::bad_alloc &) {
        return CSGM_ERR_MEMORY;
    } catch (const std::length_error &) {
        return CSGM_ERR_MEMORY;
    } catch (...) {
        return CSGM_ERR_SCENE;
    }
}

bool csg_manifold_is_available(void)
{
    return true;
}
