/* SPDX-License-Identifier: MIT
 * Half-edge meshes by OpenMesh: its decimater with the modules for quadrics (what goes first), the
 * Hausdorff distance, the deviation of normals, flips and the aspect ratio (what may go), its
 * smoothers and its flips of edges. Two modules are ours: vertices whose colours would be missed,
 * and needles, which improving is about. Seams of colours are OpenMesh's feature edges: a vertex on
 * one moves along it or not at all.
 */
#include "mesh/foreign/halfedges.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <vector>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModAspectRatioT.hh>
#include <OpenMesh/Tools/Decimater/ModHausdorffT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalDeviationT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <OpenMesh/Tools/Decimater/Observer.hh>
#include <OpenMesh/Tools/Smoother/JacobiLaplaceSmootherT.hh>

#include "base/elementary.h"

namespace
{
using mesh_type = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;
using point = mesh_type::Point;
using vertex = mesh_type::VertexHandle;
using face = mesh_type::FaceHandle;
using half = mesh_type::HalfedgeHandle;
using edge = mesh_type::EdgeHandle;
using decimater = OpenMesh::Decimater::DecimaterT<mesh_type>;
using collapse = OpenMesh::Decimater::CollapseInfoT<mesh_type>;

constexpr double DEGREE = M_PI / 180;
constexpr double FLIPPED_DEG = 60;    /* a triangle that turns by more folds over, or nearly */
constexpr double DEVIATION_DEG = 100; /* of all normals that one triangle stands for */
constexpr double THINNEST = 50;       /* longest side over altitude: nothing becomes thinner */
constexpr double CREASE_DEG = 20;     /* improving keeps the edges of such an angle */
constexpr int IMPROVING_ROUNDS = 6;

/* The watch, and the share of its work that a step has. */
struct work {
    const csg_halfedge_watch *watch;
    double from = 0, share = 1;
    bool stopped = false;

    bool stop()
    {
        stopped = stopped || watch->stop(watch->user);
        return stopped;
    }
    void tell(double fraction)
    {
        watch->progress(watch->user, from + share * std::min(fraction, 1.0));
    }
};

/* The worst of the triangles around, as altitude over longest side: 0 has no area, 0.87 is best. */
double quality(const point &a, const point &b, const point &c)
{
    double longest = std::max({(b - a).sqrnorm(), (c - b).sqrnorm(), (a - c).sqrnorm()});
    return longest > 0 ? ((b - a) % (c - a)).norm() / longest : 0;
}

struct triple {
    point a, b, c;
};

triple corners_of(const mesh_type &mesh, face f)
{
    auto v = mesh.cfv_begin(f);
    point a = mesh.point(*v++), b = mesh.point(*v++), c = mesh.point(*v);
    return {a, b, c};
}

/* Squared distance; the barycentric coordinates of the nearest point. */
double nearest_in(const triple &t, const point &p, double weights[3])
{
    point ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
    /* NOLINTNEXTLINE(misc-redundant-expression): a | b is their inner product */
    double d1 = ab | ap, d2 = ac | ap, aa = ab | ab, cc = ac | ac, x = ab | ac;
    double det = aa * cc - x * x;
    double v = det > 0 ? (cc * d1 - x * d2) / det : -1;
    double w = det > 0 ? (aa * d2 - x * d1) / det : -1;
    if (v >= 0 && w >= 0 && v + w <= 1) {
        weights[0] = 1 - v - w, weights[1] = v, weights[2] = w;
        return (t.a + ab * v + ac * w - p).sqrnorm();
    }
    double least = HUGE_VAL;
    const point *ends[3] = {&t.a, &t.b, &t.c};
    for (int k = 0; k < 3; k++) {
        const point &from = *ends[k], &to = *ends[(k + 1) % 3];
        double length = (to - from).sqrnorm();
        double s = length > 0 ? std::clamp(((p - from) | (to - from)) / length, 0.0, 1.0) : 0;
        double away = (from + (to - from) * s - p).sqrnorm();
        if (away >= least)
            continue;
        least = away;
        weights[k] = 1 - s, weights[(k + 1) % 3] = s, weights[(k + 2) % 3] = 0;
    }
    return least;
}

/* ---- modules of the decimater ------------------------------------------------------------ */

/* Asks now and then whether to go on, and forbids everything from then on; tells how far the first
 * look at all vertices is. */
template <class MeshT> class ModWatchT : public OpenMesh::Decimater::ModBaseT<MeshT>
{
  public:
    DECIMATING_MODULE(ModWatchT, MeshT, Watch);
    explicit ModWatchT(MeshT &mesh) : Base(mesh, true)
    {
    }

    void begin(work *of, double before)
    {
        work_ = of, asked_most_ = before;
    }
    float collapse_priority(const CollapseInfo &) override
    {
        if (++asked_ % 256 == 0 && !work_->stop() && double(asked_) < asked_most_)
            work_->tell(0.4 * double(asked_) / asked_most_);
        return work_->stopped ? float(Base::ILLEGAL_COLLAPSE) : float(Base::LEGAL_COLLAPSE);
    }

  private:
    work *work_ = nullptr;
    double asked_most_ = 0;
    size_t asked_ = 0;
};

/* A vertex that goes, and all that have gone before it there, find a colour like theirs at the
 * nearest point of what stays. */
template <class MeshT> class ModColorT : public OpenMesh::Decimater::ModBaseT<MeshT>
{
  public:
    DECIMATING_MODULE(ModColorT, MeshT, Color);
    explicit ModColorT(MeshT &mesh) : Base(mesh, true)
    {
        mesh.add_property(gone_);
    }
    ~ModColorT() override
    {
        Base::mesh().remove_property(gone_);
    }

    void set(const float *colors, double within, const std::vector<point> *first,
             OpenMesh::VPropHandleT<uint32_t> came_as)
    {
        colors_ = colors, within_ = within, first_ = first, came_as_ = came_as;
    }
    float collapse_priority(const CollapseInfo &ci) override
    {
        Mesh &mesh = Base::mesh();
        gather(ci);
        for (uint32_t v : gone_here_)
            if (!is_met(mesh, ci, v))
                return float(Base::ILLEGAL_COLLAPSE);
        return float(Base::LEGAL_COLLAPSE);
    }
    void preprocess_collapse(const CollapseInfo &ci) override
    {
        gather(ci);
    }
    void postprocess_collapse(const CollapseInfo &ci) override;

  private:
    /* The vertices that lie in the triangles around v0, and v0. */
    void gather(const CollapseInfo &ci)
    {
        Mesh &mesh = Base::mesh();
        gone_here_.clear();
        for (auto f = mesh.cvf_iter(ci.v0); f.is_valid(); ++f)
            gone_here_.insert(gone_here_.end(), mesh.property(gone_, *f).begin(),
                              mesh.property(gone_, *f).end());
        gone_here_.push_back(mesh.property(came_as_, ci.v0));
    }
    bool is_met(const Mesh &mesh, const CollapseInfo &ci, uint32_t v);
    double color(vertex v, int channel)
    {
        return double(colors_[3 * size_t(Base::mesh().property(came_as_, v)) + size_t(channel)]);
    }

    OpenMesh::FPropHandleT<std::vector<uint32_t>> gone_;
    OpenMesh::VPropHandleT<uint32_t> came_as_;
    std::vector<uint32_t> gone_here_;
    const float *colors_ = nullptr;
    double within_ = 0;
    const std::vector<point> *first_ = nullptr;
};

template <class MeshT> void ModColorT<MeshT>::postprocess_collapse(const CollapseInfo &ci)
{
    Mesh &mesh = Base::mesh();
    for (auto f = mesh.vf_iter(ci.v1); f.is_valid(); ++f)
        mesh.property(gone_, *f).erase(
            std::remove_if(mesh.property(gone_, *f).begin(), mesh.property(gone_, *f).end(),
                           [this](uint32_t v) {
                               return std::find(gone_here_.begin(), gone_here_.end(), v) !=
                                      gone_here_.end();
                           }),
            mesh.property(gone_, *f).end());
    for (uint32_t v : gone_here_) {
        face nearest;
        double least = HUGE_VAL;
        for (auto f = mesh.vf_iter(ci.v1); f.is_valid(); ++f) {
            triple t = corners_of(mesh, *f);
            double weights[3], away = nearest_in(t, (*first_)[v], weights);
            if (away < least)
                least = away, nearest = *f;
        }
        if (nearest.is_valid())
            mesh.property(gone_, nearest).push_back(v);
    }
}

template <class MeshT>
bool ModColorT<MeshT>::is_met(const Mesh &mesh, const CollapseInfo &ci, uint32_t v)
{
    double least = HUGE_VAL, found[3] = {0, 0, 0};
    for (auto f = mesh.cvf_iter(ci.v0); f.is_valid(); ++f) {
        if (*f == ci.fl || *f == ci.fr)
            continue;
        vertex at[3];
        int k = 0;
        for (auto corner = mesh.cfv_iter(*f); corner.is_valid(); ++corner)
            at[k++] = *corner == ci.v0 ? ci.v1 : *corner;
        triple t = {mesh.point(at[0]), mesh.point(at[1]), mesh.point(at[2])};
        double weights[3], away = nearest_in(t, (*first_)[v], weights);
        if (away >= least)
            continue;
        least = away;
        for (int channel = 0; channel < 3; channel++)
            found[channel] = weights[0] * color(at[0], channel) +
                             weights[1] * color(at[1], channel) +
                             weights[2] * color(at[2], channel);
    }
    for (int channel = 0; channel < 3; channel++)
        if (std::fabs(found[channel] - double(colors_[3 * v + uint32_t(channel)])) > within_)
            return false;
    return true;
}

/* Only vertices with a needle around them go, and only where triangles become better on the average
 * and none worse than the worst. */
template <class MeshT> class ModNeedleT : public OpenMesh::Decimater::ModBaseT<MeshT>
{
  public:
    DECIMATING_MODULE(ModNeedleT, MeshT, Needle);
    explicit ModNeedleT(MeshT &mesh) : Base(mesh, true)
    {
    }
    float collapse_priority(const CollapseInfo &ci) override
    {
        constexpr double NEEDLE = 0.2;
        Mesh &mesh = Base::mesh();
        double before = 1, after = 1, sum_before = 0, sum_after = 0;
        int count_before = 0, count_after = 0;
        for (auto f = mesh.cvf_iter(ci.v0); f.is_valid(); ++f, count_before++) {
            triple t = corners_of(mesh, *f);
            before = std::min(before, quality(t.a, t.b, t.c));
            sum_before += quality(t.a, t.b, t.c);
            if (*f == ci.fl || *f == ci.fr)
                continue;
            for (point *p : {&t.a, &t.b, &t.c})
                if (*p == ci.p0)
                    *p = ci.p1;
            after = std::min(after, quality(t.a, t.b, t.c));
            sum_after += quality(t.a, t.b, t.c);
            count_after++;
        }
        bool is_better = after >= before && count_after &&
                         sum_after / count_after > 1.02 * sum_before / count_before;
        return before < NEEDLE && is_better ? float(Base::LEGAL_COLLAPSE)
                                            : float(Base::ILLEGAL_COLLAPSE);
    }
};

/* Progress after the first look. */
class observer : public OpenMesh::Decimater::Observer
{
  public:
    observer(work *of, size_t most)
        : Observer(64), work_(of), most_(double(std::max<size_t>(most, 1)))
    {
    }
    void notify(size_t step) override
    {
        work_->tell(0.4 + 0.6 * double(step) / most_);
    }
    bool abort() const override
    {
        return work_->stop();
    }

  private:
    work *work_;
    double most_;
};

/* ---- fewer triangles --------------------------------------------------------------------- */

struct reshaper {
    mesh_type mesh;
    csg_halfedge_mesh *arrays;
    work now;
    std::vector<point> first; /* points of vertices as they came */
    OpenMesh::FPropHandleT<uint32_t> from;
    OpenMesh::VPropHandleT<uint32_t> came_as;

    bool fill();
    void empty();
    void decimate(double within, size_t triangles, bool keep_colors, bool only_needles);
    void simplify(const csg_halfedge_goals *goals);
    void smooth(uint32_t rounds);
    void improve(double most);
    void flip_edges(double most);
    bool flip_helps(edge e, double most) const;
    void relax(double most, OpenMesh::VPropHandleT<double> &moved);
    bool is_worse(vertex v, const std::vector<point> &old) const;
};

/* The arrays -> half-edges. false: a triangle does not fit. */
bool reshaper::fill()
{
    mesh.request_vertex_status();
    mesh.request_edge_status();
    mesh.request_halfedge_status();
    mesh.request_face_status();
    mesh.request_face_normals();
    mesh.add_property(from);
    mesh.add_property(came_as);
    mesh.reserve(arrays->vertex_count, 3 * arrays->triangle_count / 2, arrays->triangle_count);
    first.reserve(arrays->vertex_count);
    for (size_t i = 0; i < arrays->vertex_count; i++) {
        const double *p = arrays->points[i];
        first.emplace_back(p[0], p[1], p[2]);
        vertex v = mesh.add_vertex(first.back());
        mesh.status(v).set_locked(arrays->fixed[i]);
        mesh.property(came_as, v) = uint32_t(i);
    }
    for (size_t t = 0; t < arrays->triangle_count; t++) {
        const uint32_t *c = arrays->corners[t];
        face f = mesh.add_face(vertex(int(c[0])), vertex(int(c[1])), vertex(int(c[2])));
        if (!f.is_valid())
            return false;
        mesh.property(from, f) = uint32_t(t);
    }
    for (size_t t = 0; arrays->seams && t < arrays->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            if (!arrays->seams[3 * t + size_t(k)])
                continue;
            const uint32_t *c = arrays->corners[t];
            half h = mesh.find_halfedge(vertex(int(c[k])), vertex(int(c[(k + 1) % 3])));
            mesh.status(mesh.edge_handle(h)).set_feature(true);
            mesh.status(mesh.from_vertex_handle(h)).set_feature(true);
            mesh.status(mesh.to_vertex_handle(h)).set_feature(true);
        }
    for (vertex v : mesh.vertices()) { /* where seams meet or end */
        int seams = 0;
        for (auto e = mesh.cve_iter(v); e.is_valid(); ++e)
            seams += mesh.status(*e).feature();
        if (mesh.status(v).feature() && seams != 2)
            mesh.status(v).set_locked(true);
    }
    mesh.update_face_normals();
    return true;
}

void reshaper::empty()
{
    std::vector<uint32_t> number(mesh.n_vertices(), UINT32_MAX);
    size_t vertices = 0, triangles = 0;
    for (face f : mesh.faces())
        if (!mesh.status(f).deleted())
            for (auto v = mesh.cfv_iter(f); v.is_valid(); ++v)
                number[size_t((*v).idx())] = 0;
    for (vertex v : mesh.vertices()) {
        if (mesh.status(v).deleted() || number[size_t(v.idx())] == UINT32_MAX)
            continue;
        for (size_t k = 0; k < 3; k++)
            arrays->points[vertices][k] = mesh.point(v)[k];
        arrays->vertex_from[vertices] = mesh.property(came_as, v);
        number[size_t(v.idx())] = uint32_t(vertices++);
    }
    for (face f : mesh.faces()) {
        if (mesh.status(f).deleted())
            continue;
        int k = 0;
        for (auto v = mesh.cfv_iter(f); v.is_valid(); ++v)
            arrays->corners[triangles][k++] = number[size_t((*v).idx())];
        arrays->triangle_from[triangles++] = mesh.property(from, f);
    }
    arrays->vertex_count = vertices;
    arrays->triangle_count = triangles;
}

size_t triangles_of(const mesh_type &mesh)
{
    size_t count = 0;
    for (face f : mesh.all_faces())
        count += !mesh.status(f).deleted();
    return count;
}

/* within 0: no bound but the number of triangles; triangles 0: as far as it goes. */
void reshaper::decimate(double within, size_t triangles, bool keep_colors, bool only_needles)
{
    using namespace OpenMesh::Decimater;
    decimater by(mesh);
    ModWatchT<mesh_type>::Handle watch;
    ModQuadricT<mesh_type>::Handle quadric;
    ModNormalFlippingT<mesh_type>::Handle flipping;
    ModAspectRatioT<mesh_type>::Handle aspect;
    ModHausdorffT<mesh_type>::Handle hausdorff;
    ModNormalDeviationT<mesh_type>::Handle deviation;
    ModColorT<mesh_type>::Handle color;
    ModNeedleT<mesh_type>::Handle needle;
    by.add(watch);
    by.module(watch).begin(&now, 6 * double(mesh.n_vertices()));
    by.add(quadric);
    by.module(quadric).unset_max_err();
    by.add(flipping);
    by.module(flipping).set_max_normal_deviation(only_needles ? CREASE_DEG : FLIPPED_DEG);
    if (only_needles) {
        by.add(needle);
    } else {
        by.add(aspect);
        by.module(aspect).set_aspect_ratio(THINNEST);
        by.module(aspect).set_binary(true);
    }
    if (within > 0) {
        by.add(deviation);
        by.module(deviation).set_normal_deviation(DEVIATION_DEG);
        by.module(deviation).set_binary(true);
        by.add(hausdorff);
        by.module(hausdorff).set_tolerance(within);
    }
    if (keep_colors && arrays->colors) {
        by.add(color);
        by.module(color).set(arrays->colors, arrays->color_within, &first, came_as);
    }
    if (!by.initialize())
        return;
    size_t count = triangles_of(mesh);
    size_t most = triangles < count ? (count - triangles + 1) / 2 : 0;
    observer told(&now, triangles ? most : mesh.n_vertices());
    by.set_observer(&told);
    if (!triangles)
        by.decimate();
    else if (most)
        by.decimate(most);
}

void reshaper::simplify(const csg_halfedge_goals *goals)
{
    size_t goal = size_t(goals->triangles);
    decimate(goals->within, goal, true, false);
    if (goal && arrays->colors && triangles_of(mesh) > goal && !now.stop())
        decimate(goals->within, goal, false, false); /* so many were asked for: colours give way */
    mesh.garbage_collection();
}

/* ---- smoother ---------------------------------------------------------------------------- */

void reshaper::smooth(uint32_t rounds)
{
    using namespace OpenMesh::Smoother;
    mesh.request_vertex_normals();
    {
        JacobiLaplaceSmootherT<mesh_type> by(mesh);
        by.initialize(SmootherT<mesh_type>::Tangential_and_Normal, SmootherT<mesh_type>::C1);
        by.skip_features(true);
        for (uint32_t i = 0; i < rounds && !now.stop(); i++) {
            by.smooth(1);
            now.tell(double(i + 1) / rounds);
        }
    }
    mesh.release_vertex_normals();
    mesh.update_face_normals();
}

/* ---- better triangles -------------------------------------------------------------------- */

double angle_at(const point &apex, const point &a, const point &b)
{
    double c = ((a - apex) | (b - apex));
    return csg_atan2(((a - apex) % (b - apex)).norm(), c);
}

/* Delaunay: the angles that see the edge sum to more than 180 degrees. The two triangles lie nearly
 * in a plane, and stay upright. */
bool reshaper::flip_helps(edge e, double most) const
{
    half h = mesh.halfedge_handle(e, 0), o = mesh.halfedge_handle(e, 1);
    if (mesh.is_boundary(e) || mesh.status(e).feature())
        return false;
    point a = mesh.point(mesh.from_vertex_handle(h)), b = mesh.point(mesh.to_vertex_handle(h));
    point c = mesh.point(mesh.to_vertex_handle(mesh.next_halfedge_handle(h)));
    point d = mesh.point(mesh.to_vertex_handle(mesh.next_halfedge_handle(o)));
    if (angle_at(c, a, b) + angle_at(d, a, b) <= M_PI + 1e-9)
        return false;
    point n = (b - a) % (c - a), m = (a - b) % (d - b), fresh = (c - d) % (a - d),
          other = (d - c) % (b - c);
    double cosine = csg_cos(CREASE_DEG * DEGREE);
    if ((n | m) < cosine * n.norm() * m.norm() || (fresh | n) <= 0 || (fresh | m) <= 0 ||
        (other | n) <= 0 || (other | m) <= 0)
        return false;
    point across = (b - a) % (d - c); /* how far the two diagonals miss each other */
    double length = across.norm();
    return !(length > 0) || std::fabs((c - a) | across) / length <= most;
}

void reshaper::flip_edges(double most)
{
    for (int sweep = 0; sweep < 4 && !now.stop(); sweep++) {
        size_t flips = 0;
        for (edge e : mesh.edges()) {
            if (!flip_helps(e, most) || !mesh.is_flip_ok(e))
                continue;
            mesh.flip(e);
            flips++;
        }
        if (!flips)
            break;
    }
    mesh.update_face_normals();
}

bool reshaper::is_worse(vertex v, const std::vector<point> &old) const
{
    double before = 1, after = 1;
    for (auto f = mesh.cvf_iter(v); f.is_valid(); ++f) {
        vertex at[3];
        int k = 0;
        for (auto corner = mesh.cfv_iter(*f); corner.is_valid(); ++corner)
            at[k++] = *corner;
        const point &a = old[size_t(at[0].idx())], &b = old[size_t(at[1].idx())],
                    &c = old[size_t(at[2].idx())];
        triple t = {mesh.point(at[0]), mesh.point(at[1]), mesh.point(at[2])};
        before = std::min(before, quality(a, b, c));
        after = std::min(after, quality(t.a, t.b, t.c));
        point was = (b - a) % (c - a), is = (t.b - t.a) % (t.c - t.a);
        if ((was | is) < csg_cos(CREASE_DEG * DEGREE) * was.norm() * is.norm())
            return true;
    }
    return after < before;
}

/* One step of the smoother along the surface; moves that leave the surface or spoil a triangle are
 * taken back. */
void reshaper::relax(double most, OpenMesh::VPropHandleT<double> &moved)
{
    using namespace OpenMesh::Smoother;
    std::vector<point> old;
    for (vertex v : mesh.vertices())
        old.push_back(mesh.point(v));
    {
        JacobiLaplaceSmootherT<mesh_type> by(mesh);
        by.initialize(SmootherT<mesh_type>::Tangential, SmootherT<mesh_type>::C0);
        by.skip_features(true);
        by.smooth(1);
    }
    for (vertex v : mesh.vertices()) {
        double least = HUGE_VAL, weights[3];
        for (auto f = mesh.cvf_iter(v); f.is_valid(); ++f) {
            point at[3];
            int k = 0;
            for (auto corner = mesh.cfv_iter(*f); corner.is_valid(); ++corner)
                at[k++] = old[size_t((*corner).idx())];
            least = std::min(least, nearest_in({at[0], at[1], at[2]}, mesh.point(v), weights));
        }
        double away = std::sqrt(least) + mesh.property(moved, v);
        if (away > most)
            mesh.set_point(v, old[size_t(v.idx())]);
        else
            mesh.property(moved, v) = away;
    }
    bool again = true;
    while (again) { /* each turn takes at least one move back */
        again = false;
        for (vertex v : mesh.vertices())
            if (mesh.point(v) != old[size_t(v.idx())] && is_worse(v, old)) {
                mesh.set_point(v, old[size_t(v.idx())]);
                again = true;
            }
    }
    mesh.update_face_normals();
}

void reshaper::improve(double most)
{
    double before = now.from, share = now.share;
    OpenMesh::VPropHandleT<double> moved;
    now.share = share / 2;
    decimate(most / 2, 0, true, true);
    mesh.garbage_collection();
    mesh.request_vertex_normals();
    mesh.add_property(moved, "moved");
    for (vertex v : mesh.vertices())
        mesh.property(moved, v) = 0;
    for (edge e :
         mesh.edges()) { /* creases stay: their vertices are not moved, their edges not flipped */
        bool is_crease = mesh.status(e).feature() ||
                         std::fabs(mesh.calc_dihedral_angle(e)) > CREASE_DEG * DEGREE;
        mesh.status(e).set_feature(is_crease);
    }
    now.from = before + share / 2;
    for (int i = 0; i < IMPROVING_ROUNDS && !now.stop(); i++) {
        flip_edges(most / 4);
        relax(most / 4, moved);
        now.tell(double(i + 1) / IMPROVING_ROUNDS);
    }
    flip_edges(most / 4);
    mesh.remove_property(moved);
    mesh.release_vertex_normals();
    now.from = before, now.share = share;
}

csg_halfedge_result reshape(csg_halfedge_mesh *mesh, const csg_halfedge_goals *goals,
                            const csg_halfedge_watch *watch)
{
    omerr().disable();
    omlog().disable();
    omout().disable();
    reshaper job;
    job.arrays = mesh;
    job.now.watch = watch;
    if (!job.fill())
        return CSG_HALFEDGES_REFUSED;
    int steps =
        (goals->smooth > 0) + (goals->within > 0 || goals->triangles) + (goals->improve > 0);
    job.now.share = 1.0 / std::max(steps, 1);
    if (goals->smooth && !job.now.stop()) {
        job.smooth(goals->smooth);
        job.now.from += job.now.share;
    }
    if ((goals->within > 0 || goals->triangles) && !job.now.stop()) {
        job.simplify(goals);
        job.now.from += job.now.share;
    }
    if (goals->improve > 0 && !job.now.stop())
        job.improve(goals->improve);
    if (job.now.stop())
        return CSG_HALFEDGES_STOPPED;
    job.empty();
    return CSG_HALFEDGES_DONE;
}
} // namespace

bool csg_halfedges_available(void)
{
    return true;
}

csg_halfedge_result csg_halfedges_reshape(csg_halfedge_mesh *mesh, const csg_halfedge_goals *goals,
                                          const csg_halfedge_watch *watch)
{
    try {
        return reshape(mesh, goals, watch);
    } catch (const std::bad_alloc &) {
        return CSG_HALFEDGES_NO_MEMORY;
    } catch (...) {
        return CSG_HALFEDGES_REFUSED;
    }
}
