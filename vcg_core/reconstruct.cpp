// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Target space in, neural mesh out.
#include "vcg_core/reconstruct.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "vcg_core/fit/fit.h"
#include "vcg_core/learning/feature_counter.h"
#include "vcg_core/learning/learner.h"
#include "vcg_core/mesh/simplify.h"
#include "vcg_core/rms_error.h"
#include "vcg_core/shell/shell.h"

namespace neuralmesh {

namespace {

constexpr int kDistanceSamples = 20000;
/// A shell stands off the cloud by its radius; so many signals a vertex bring it down.
constexpr int kSignalsToLand = 100;

/// The caller's progress as one run: fractions never decrease, and a wish to stop is remembered.
class Run : public Progress {
public:
    explicit Run(Progress& progress) : progress_(progress) {}
    bool operator()(double fraction, const char* text) override {
        done_ = std::max(done_, fraction);
        stopped_ = stopped_ || !progress_(done_, text);
        return !stopped_;
    }
    bool stopped() const { return stopped_; }

private:
    Progress& progress_;
    double done_ = 0;
    bool stopped_ = false;
};

struct Start {
    Network network;
    int signals_to_land;
    bool encloses_space;                      ///< else the shell has two layers with nothing between them
    std::optional<TargetSpace> inliers = {};  ///< what is to be learned, if that is less than the target
};

/// The paper's start: a tetrahedron in the middle of the cloud, which lies around the origin.
Start tetrahedron() {
    constexpr float kA = 0.1F;
    return {Network({{kA, kA, kA}, {-kA, -kA, kA}, {-kA, kA, -kA}, {kA, -kA, -kA}},
                    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}),
            0, true};
}

Start start_of(const TargetSpace& target, const Settings& settings, Report& report, Progress& progress) {
    if (settings.start_mesh == kTetrahedron) return tetrahedron();
    ShellOptions options;
    options.target_vertices = settings.target_vertices;
    options.threads = settings.threads;
    Random random(static_cast<std::uint64_t>(settings.random_seed) + 2);
    StartMesh shell = shell_of(target, options, random, progress);
    std::optional<TargetSpace> inliers;
    if (!shell.outliers.empty()) inliers = target.without(shell.outliers);
    if (inliers)
        for (vcg::Point3f& p : shell.positions) p = inliers->frame().inside(target.frame().outside(p));
    report.warnings.insert(report.warnings.end(), shell.warnings.begin(), shell.warnings.end());
    const auto vertices = static_cast<int>(shell.positions.size());
    if (vertices > settings.target_vertices) {
        report.warnings.push_back("The shell of the cloud, with " + std::to_string(shell.components) +
                                  " components and genus " + std::to_string(shell.genus) + ", needs " +
                                  std::to_string(vertices) + " vertices, more than the " +
                                  std::to_string(settings.target_vertices) +
                                  " asked for: the learning started from a tetrahedron instead. Raise "
                                  "target_vertices to keep the shape.");
        Start start = tetrahedron();
        start.inliers = std::move(inliers);
        return start;
    }
    report.topology_confidence = shell.confidence;
    return {Network(shell.positions, shell.faces), kSignalsToLand, shell.encloses_space, std::move(inliers)};
}

/// The layers of a sheet come to lie in each other, folded: area vectors cancel, and what is left of them is
/// no normal to smooth at right angles to. It throws vertices off the sheet, which win no signal any more.
Settings settings_for(const Start& start, Settings settings, Report& report) {
    if (start.encloses_space || settings.smoothing_steps == 0) return settings;
    settings.smoothing_steps = 0;
    report.warnings.push_back(
        "Between the two sides of such a surface there is no room to smooth it in: it was learned as with "
        "smoothing_steps 0, and its triangles are less even than otherwise.");
    return settings;
}

/// The fit judges better than the learning where vertices are wanted, so the network grows beyond its size
/// and the fit takes out what it misses least. For large meshes that is not worth the time. Found by
/// experiment.
int vertices_to_learn(const TargetSpace& target, const Start& start, const Settings& settings) {
    constexpr int kMostBeyond = 2500;
    constexpr std::size_t kPointsPerVertex = 10;
    const int n = settings.target_vertices;
    if (!settings.fit_to_points || settings.utility_counter != kNormalCounter ||
        settings.start_mesh == kTetrahedron || !start.encloses_space || settings.stop_below_mean_counter > 0)
        return n;
    const int wanted = n + std::max(0, std::min(3 * n, kMostBeyond - n / 2));
    if (target.has_faces()) return wanted;
    const std::size_t places = target.positions().size() / kPointsPerVertex;
    return std::max(n, static_cast<int>(std::min(places, static_cast<std::size_t>(wanted))));
}

void write_geometry(const Network& network, const Frame& frame, NeuralMesh& mesh) {
    std::vector<VertexId> index(static_cast<std::size_t>(network.slot_count()), -1);
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        if (!network.alive(v)) continue;
        index[static_cast<std::size_t>(v)] = static_cast<VertexId>(mesh.positions.size());
        mesh.positions.push_back(frame.outside(network.position(v)));
    }
    mesh.faces = network.faces();
    for (Triangle& f : mesh.faces)
        for (VertexId& v : f) v = index[static_cast<std::size_t>(v)];
}

/// \p origin: whose counter a vertex of \p network carries; empty: its own.
void write_counters(const Learner& learner, const Network& network, const std::vector<VertexId>& origin,
                    const Settings& settings, NeuralMesh& mesh) {
    const bool creases = settings.feature_measure == kCreaseMeasure;
    const std::vector<float> measure =
        creases ? learner.crease_measure().values(learner.network(), network, origin) : std::vector<float>();
    double sum = 0;
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        if (!network.alive(v)) continue;
        const auto slot = static_cast<std::size_t>(v);
        mesh.counters.push_back(
            creases ? measure[slot] : learner.feature_counters().value(origin.empty() ? v : origin[slot]));
        sum += static_cast<double>(mesh.counters.back());
    }
    const double mean = sum / static_cast<double>(mesh.counters.size());
    const double threshold =
        creases ? settings.feature_threshold : feature_threshold(settings.feature_threshold, mean);
    for (const float n_c : mesh.counters) {
        mesh.features.push_back(static_cast<double>(n_c) > threshold ? 1 : 0);
        mesh.report.feature_vertices += mesh.features.back();
    }
    mesh.report.mean_counter = mean;
}

/// But for signals, splits and collapses, which grow() counts.
void write_report(const Learner& learner, const Network& network, Report& report) {
    report.vertices = network.vertex_count();
    report.faces = network.face_count();
    report.genus = network.genus();
    report.boundary_loops = network.boundary_loop_count();
    report.components = network.component_count();
    if (learner.forced() && report.stop_reason == StopReason::target_reached)
        report.warnings.push_back(
            "Growth had stalled, so it was forced: more vertices were asked for than the points have places "
            "for. "
            "Lower target_vertices if the mesh has slivers.");
    if (report.stop_reason == StopReason::cut_short)
        report.warnings.push_back("The mesh was cut short at " + std::to_string(report.vertices) +
                                  " vertices: it did not grow on within the bound on signals. Lower "
                                  "signals_per_split or min_wins_per_split, or raise signals_per_collapse.");
}

/// The learner as it ended and the network as the fit left it.
struct Grown {
    std::optional<Learner> learner;
    Network network;
    FitReport fit;
};

/// Grows the network of \p start and fits it, and enters in \p report why learning ended and, added to those
/// of a growth before, what it took.
void grow(const TargetSpace& target, const Settings& settings, const Settings& learner_settings,
          const Start& start, Run& run, Grown& grown, Report& report) {
    PartOf learning(run, 0.1, settings.fit_to_points ? 0.8 : 1);
    PartOf fitting(run, 0.8, 1);
    grown.learner.emplace(target, learner_settings, start.network);
    grown.fit = FitReport();  // one of a network that was given up says nothing of this one
    const StopReason reason = grown.learner->run(start.signals_to_land, learning);
    grown.network = grown.learner->network();
    FitOptions options;
    // A mesh that is to follow the density of the cloud must not follow the error instead; and on a sheet the
    // error is at the rim, where what is put in stands out.
    options.redistribute = settings.utility_counter == kNormalCounter && start.encloses_space;
    options.target_vertices = settings.target_vertices;
    if (settings.fit_to_points && !run.stopped())
        grown.fit = fit_to_points(grown.network, target, options, settings.threads,
                                  static_cast<std::uint64_t>(settings.random_seed) + 3, fitting);
    report.stop_reason = run.stopped() ? StopReason::cancelled : reason;
    report.signals += grown.learner->signals();
    report.splits += grown.learner->splits();
    report.collapses += grown.learner->collapses();
}

/// Repeated points say nothing of the surface, and would make it dense or a component where they are.
std::optional<TargetSpace> without_repeats(const TargetSpace& target, Report& report) {
    std::optional<TargetSpace> once = target.each_place_once();
    if (once) {
        const std::size_t all = target.positions().size();
        report.warnings.push_back(std::to_string(all - once->positions().size()) + " of " +
                                  std::to_string(all) +
                                  " points repeat others: every place was learned once.");
    }
    return once;
}

}  // namespace

NeuralMesh reconstruct(const TargetSpace& given, const Settings& settings, Progress& progress) {
    const auto begin = std::chrono::steady_clock::now();
    settings.check();
    NeuralMesh mesh;
    Run run(progress);
    PartOf starting(run, 0, 0.1);
    const std::optional<TargetSpace> once = without_repeats(given, mesh.report);
    const TargetSpace& places = once ? *once : given;
    const Start start = start_of(places, settings, mesh.report, starting);
    const TargetSpace& target = start.inliers ? *start.inliers : places;
    const Settings learner_settings = settings_for(start, settings, mesh.report);
    Settings oversized = learner_settings;
    oversized.target_vertices = vertices_to_learn(target, start, settings);
    Grown grown;
    grow(target, settings, oversized, start, run, grown, mesh.report);
    const bool too_many = grown.network.vertex_count() > settings.target_vertices || grown.learner->forced();
    if (too_many && !run.stopped() && oversized.target_vertices > settings.target_vertices)
        grow(target, settings, learner_settings, start, run, grown, mesh.report);

    Network& network = grown.network;
    // Only a run that was stopped before the fit had taken out enough has more.
    if (network.vertex_count() > settings.target_vertices) simplify(network, settings.target_vertices);
    network.orient_outward();
    write_geometry(network, target.frame(), mesh);
    // A fit that was taken back has put nothing in: every vertex has a counter of its own.
    write_counters(*grown.learner, network, grown.fit.improved ? grown.fit.origin : std::vector<VertexId>(),
                   settings, mesh);
    write_report(*grown.learner, network, mesh.report);
    Random random(static_cast<std::uint64_t>(settings.random_seed) + 1);
    mesh.report.rms_error = 100 * rms_distance(target, network, kDistanceSamples, random);
    mesh.report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return mesh;
}

}  // namespace neuralmesh
