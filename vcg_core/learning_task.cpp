// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/learning_task.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "vcg_core/base/ablation.h"
#include "vcg_core/base/text.h"
#include "vcg_core/cloud/outlier_removal.h"
#include "vcg_core/few_points.h"
#include "vcg_core/layer_normals.h"
#include "vcg_core/open_or_closed.h"
#include "vcg_core/plan.h"
#include "vcg_core/rounded_coordinates.h"
#include "vcg_core/start/given_start.h"
#include "vcg_core/start/open_start.h"
#include "vcg_core/start/shell.h"

namespace neuralmesh {

namespace {

/// A shell lies outside the cloud by its radius. This many signals per vertex bring it down. An open start
/// lies on the cloud, but its vertices were vertices of a finer mesh.
constexpr int kLandingSignals = 100, kLandingSignalsOfOpen = 30;
/// Where walls are thin, few: the start mesh is coarser than what is grown, and the longer it lands the more
/// of its vertices go through to the other side. Nested boxes half an edge apart have an error of .0005 to
/// .003 % with 10 or none, and of up to .03 % with 40 and more (`walls` of ablation.py).
constexpr int kLandingSignalsAtWalls = 10;
/// Start vertices for each one asked for, where the fit reduces them: walls of half an edge need seven
/// (shell.h).
constexpr int kMostPerFinal = 8, kMostStartVertices = 50000;
/// Start vertices of an open mesh for each one that is grown. With two thirds a vertex of a square with 250
/// stood out of its points by 2 % of the diagonal.
constexpr double kStartShare = 0.5;
constexpr double kShellMade = 0.6;  // of the progress
/// More points tell the surface, and learning gives better shaped faces than those of their hull.
constexpr std::size_t kFewPoints = 128;

/// The start mesh of the paper, in the middle of the cloud, which is the origin of the core's frame; or a
/// large one, whose corners lie outside of most clouds. A small one that begins between handles reaches their
/// insides first, and turns inside out there.
Network tetrahedron(bool large) {
    const float a = large ? 0.55F : 0.1F;
    return Network({{a, a, a}, {-a, -a, a}, {-a, a, -a}, {a, -a, -a}},
                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
}

/// Where many points repeat others, signals would be drawn there more often, and the mesh would be denser or
/// grow a component. A warning says so, or of rounding, which makes points repeat others.
void remove_repeated_points(LearningTask& task) {
    const std::string rounding = warning_of_rounding(task.given);
    if (!rounding.empty()) task.warnings.push_back(rounding);
    task.cleaned = task.given.each_place_once();
    if (!task.cleaned || !rounding.empty()) return;
    const std::size_t all = task.given.positions().size();
    task.warnings.push_back(std::to_string(all - task.cleaned->positions().size()) + " of " +
                            std::to_string(all) + " points repeat others: every place was learned once.");
}

/// A cloud with a larger share of outliers is more noise than surface.
constexpr double kMostlyNoise = 0.3;

/// Leaves out the points of \p out, if the others span a surface.
bool leave_out(LearningTask& task, const std::vector<std::uint8_t>& out) {
    std::optional<TargetSpace> rest = task.target().without(out);
    if (!rest) return false;
    task.outliers += static_cast<int>(std::count(out.begin(), out.end(), 1));
    task.cleaned = std::move(rest);
    return true;
}

/// Points that start meshes are made from, if the target has faces.
constexpr int kDrawn = 200000;

/// The points to learn and their surveys, made anew after some were left out; of a target with faces, points
/// drawn from them.
class Survey {
public:
    explicit Survey(const Settings& settings)
        : threads_(settings.threads), random_(stream_seed(settings.random_seed, Stream::shell)) {}
    const std::vector<vcg::Point3f>& points_of(const TargetSpace& target) {
        if (!target.has_faces()) return target.positions();
        while (drawn_.size() < kDrawn) drawn_.push_back(target.sample(random_));
        return drawn_;
    }
    Surveys& of(const TargetSpace& target) {
        const std::vector<vcg::Point3f>& points = points_of(target);
        if (!surveys_ || surveys_->points().cloud.size() != points.size()) surveys_.emplace(points, threads_);
        return *surveys_;
    }

private:
    int threads_;
    Random random_;
    std::vector<vcg::Point3f> drawn_;
    std::optional<Surveys> surveys_;
};

Shell make_shell(const TargetSpace& target, const Settings& settings, Survey& survey, Progress& progress) {
    ShellOptions options;
    options.target_vertices = settings.target_vertices;
    // Without the fit, which takes vertices away again, more of them at the start would leave none to split.
    if (settings.redistributes_vertices())
        options.most_vertices = std::min(kMostPerFinal * settings.target_vertices, kMostStartVertices);
    options.threads = settings.threads;
    options.learn_outliers = !settings.remove_outliers || target.is_exact();
    return Shell(survey.points_of(target), survey.of(target), options, progress);
}

void remove_outliers(LearningTask& task, Survey& survey, int threads, Progress& progress) {
    const std::vector<std::uint8_t> out =
        find_outliers(survey.of(task.target()).points(), threads,
                      [&progress] { progress(0, "Start mesh: looking for outliers"); });
    if (out.empty()) return;
    const auto count = static_cast<std::size_t>(std::count(out.begin(), out.end(), 1));
    const std::size_t all = out.size();
    std::string sentence = share_of_points(count, all);
    if (!leave_out(task, out)) {
        sentence += " look like outliers, and the others span no surface: all points were learned.";
    } else if (static_cast<double>(count) > kMostlyNoise * static_cast<double>(all)) {
        sentence +=
            " were left out as outliers. That is unusually many: check the mesh, and switch remove_outliers off "
            "if it misses parts.";
    } else {
        sentence += " were left out as outliers.";
    }
    task.warnings.push_back(sentence);
}

LearningTask points_to_learn(const TargetSpace& given, const Settings& settings, Survey& survey,
                             Progress& progress) {
    LearningTask task(given);
    remove_repeated_points(task);
    if (settings.remove_outliers && !given.is_exact())
        remove_outliers(task, survey, settings.threads, progress);
    return task;
}

void measure_noise(LearningTask& task, Survey& survey, const Settings& settings) {
    const std::vector<vcg::Point3f>& points = task.target().positions();
    const int vertices = settings.target_vertices;
    const SurfaceSurvey& surface = survey.of(task.target()).surface();
    task.noise = surface.noise_in_edges(static_cast<double>(points.size()) / vertices);
    // Closed surfaces are learned from even samples mostly, which one number describes. With the noise of
    // each place feline would have 1.15 times the error at .1 % of the diagonal (50,000 points, 2,000
    // vertices).
    const bool open = task.network.boundary_loop_count() > 0;
    if (!open || task.target().is_exact() || skips("noise_by_place")) return;
    if (surface.clutter() < 1) task.noise_by_place.emplace(surface);
}

/// Whether the points have normals that are to be used; a warning, if theirs cannot.
bool normals_serve(LearningTask& task, Survey& survey, const Settings& settings) {
    if (!settings.use_normals || !task.target().has_normals()) return false;
    const std::string why_not = why_normals_do_not_serve(task.target(), survey.of(task.target()));
    if (!why_not.empty()) task.warnings.push_back(why_not);
    return why_not.empty();
}

/// Gives the points weights by which signals are even over the surface.
void weigh_points(LearningTask& task, Survey& survey) {
    if (skips("even_sampling")) return;
    std::optional<TargetSpace> even = task.target().evenly(survey.of(task.target()).points());
    if (even) task.cleaned = std::move(even);
}

/// A group of points that got no component of the start mesh would be reached by a spike.
void remove_groups_without_component(LearningTask& task, const std::vector<std::uint8_t>& outliers,
                                     const std::vector<std::vector<vcg::Point3f>*>& meshes) {
    if (outliers.empty()) return;
    const Frame before = task.target().frame();
    if (!leave_out(task, outliers)) return;
    for (std::vector<vcg::Point3f>* positions : meshes)
        for (vcg::Point3f& p : *positions) p = task.target().frame().inside(before.outside(p));
}

OpenStart make_open_start(const TargetSpace& target, const Settings& settings, Survey& survey,
                          Progress& progress) {
    OpenStartOptions options;
    const int surplus = settings.redistributes_vertices() ? usual_surplus(settings.target_vertices) : 0;
    const int grown = settings.target_vertices + surplus;
    options.wanted_vertices = std::clamp(static_cast<int>(kStartShare * grown), 4, kMostStartVertices);
    options.target_vertices = settings.target_vertices;
    options.close_holes_up_to = settings.close_holes_up_to / target.frame().diagonal;
    options.learn_outliers = !settings.remove_outliers || target.is_exact();
    if (settings.surface != kOpenSurface && settings.close_holes_up_to < 0)
        options.closed_up_to = kWidestClosed;
    options.use_normals = settings.use_normals;
    Random random(stream_seed(settings.random_seed, Stream::shell));
    options.threads = settings.threads;
    return open_start(target, survey.points_of(target), survey.of(target), options, random, progress);
}

void warn_of_thin_walls(LearningTask& task, const LayerFigures& layers, const char* outcome) {
    const std::string text = warning_of_thin_walls(layers, task.target().frame().diagonal, outcome);
    if (!text.empty()) task.warnings.push_back(text);
}

/// Of those of a start mesh, an OpenStart or a StartMesh; the fit, if there is one, reduces it.
template <class Start>
int vertices_needed(const Start& start, const Settings& settings) {
    return settings.redistributes_vertices() ? start.fewest_vertices
                                             : static_cast<int>(start.positions.size());
}

/// The start mesh of one layer of a cloud that may be open, or whose shell encloses no space; nothing if its
/// shell is the better start. \p is_convex: the points lie on their convex hull.
std::optional<OpenStart> try_open_start(LearningTask& task, const Enclosure& shell, bool is_convex,
                                        const Settings& settings, Survey& survey, Progress& progress) {
    const TargetSpace& target = task.target();
    const bool automatic = settings.surface == kAutomatic;
    try {
        OpenStart start = make_open_start(target, settings, survey, progress);
        warn_of_thin_walls(task, start.layers,
                           shell.encloses_space
                               ? "The sides of the mesh may cross there."
                               : "They were learned as one sheet, closed around both sides.");
        const bool open = automatic && is_open(start, shell, target, settings);
        const bool fits = vertices_needed(start, settings) <= settings.target_vertices;
        if ((open && (fits || !shell.encloses_space)) || (fits && encloses_more(start, shell))) return start;
    } catch (const NoSurfaceError&) {
        if (automatic && !shell.encloses_space && !is_convex) throw;
    } catch (const InputError&) {  // too few points
    }
    return {};
}

void begin_open(LearningTask& task, OpenStart start, const Settings& settings) {
    const int needed = vertices_needed(start, settings);
    if (needed > settings.target_vertices)
        throw SettingError("The open surface, with " + std::to_string(start.components) + " components, " +
                           std::to_string(start.loops) + " boundary loops and genus " +
                           std::to_string(start.genus) + ", needs " + std::to_string(needed) +
                           " vertices to begin with: raise " + "target_vertices from " +
                           std::to_string(settings.target_vertices) + ", or choose surface 1 (closed).");
    task.warnings.insert(task.warnings.end(), start.warnings.begin(), start.warnings.end());
    if (settings.surface == kAutomatic && start.loops > 0)
        task.warnings.push_back(
            "The points enclose no space, or openings too wide to close: the surface ends "
            "where they end. Choose surface 1 to close it.");
    std::vector<vcg::Point3f> viewer(start.viewer ? 1 : 0, start.viewer.value_or(vcg::Point3f()));
    remove_groups_without_component(task, start.outliers, {&start.positions, &viewer});
    task.parts_faced_by_normals = start.faced_by_normals;
    task.network = Network(start.positions, start.faces);
    if (!viewer.empty()) task.network.set_viewer(viewer.front());
    task.landing_signals = kLandingSignalsOfOpen;
}

void begin_tetrahedron(LearningTask& task, const Settings& settings) {
    task.network = tetrahedron(settings.learn_topology);
    task.topology_rules.from_tetrahedron = true;
    if (settings.surface == kClosedSurface) return;
    const double asked = settings.close_holes_up_to / task.target().frame().diagonal;
    const double chosen = settings.surface == kOpenSurface ? 0 : kWidestClosed;
    task.topology_rules.opens_from = static_cast<float>(asked >= 0 ? asked : chosen);
}

std::string too_large(const StartMesh& shell, int needed, int final_vertices) {
    return "The shell of the cloud, with " + std::to_string(shell.components) + " components and genus " +
           std::to_string(shell.genus) + ", needs " + std::to_string(needed) + " vertices, more than the " +
           std::to_string(final_vertices) +
           " asked for: learning started from a tetrahedron instead. Raise target_vertices to keep the "
           "shape.";
}

void begin_closed(LearningTask& task, StartMesh shell, const Settings& settings) {
    task.warnings.insert(task.warnings.end(), shell.warnings.begin(), shell.warnings.end());
    const double diagonal = task.target().frame().diagonal;
    remove_groups_without_component(task, shell.outliers, {&shell.positions, &shell.walls.positions});
    for (float& length : shell.walls.thickenings)
        length *= static_cast<float>(diagonal / task.target().frame().diagonal);
    const int needed = task.vertices_needed = vertices_needed(shell, settings);
    if (needed > settings.target_vertices) {
        task.warnings.push_back(too_large(shell, needed, settings.target_vertices));
        begin_tetrahedron(task, settings);
        return;
    }
    task.network = Network(shell.positions, shell.faces);
    task.walls = std::move(shell.walls);
    task.landing_signals = task.walls.faces.empty() ? kLandingSignals : kLandingSignalsAtWalls;
    task.encloses_space = shell.encloses_space;
    task.topology_confidence = shell.confidence;
    if (!task.encloses_space && settings.smoothing_steps > 0)
        task.warnings.push_back(
            "The two layers of such a surface lie on each other, which leaves no room to smooth them: it was "
            "learned with smoothing_steps 0, and its triangles are less even than usual.");
}

void begin_given(LearningTask& task, const IndexedMesh<double>& mesh, const Settings& settings) {
    const GivenStart start = given_start(mesh, task.target());
    const std::size_t vertices = start.positions.size();
    if (vertices > static_cast<std::size_t>(settings.target_vertices))
        throw SettingError(
            "The start layer needs " + std::to_string(vertices) + " vertices: raise target_vertices from " +
            std::to_string(settings.target_vertices) +
            ", or reduce a copy of the layer with the filter 'Simplification: Quadric Edge Collapse "
            "Decimation'.");
    task.network = Network(start.positions, start.faces);
    const bool closed = task.network.boundary_loop_count() == 0;
    if (settings.surface == (closed ? kOpenSurface : kClosedSurface))
        task.warnings.push_back(std::string("The surface is ") + (closed ? "closed" : "open") +
                                ", because the start layer is. Choose start_mesh 0 for another one.");
}

/// The surface between few points, as the start mesh or as what its shell is of.
void begin_convex(LearningTask& task, ConvexSurface convex, const Settings& settings, Survey& survey,
                  Progress& progress) {
    task.cleaned = std::move(convex.target);
    task.is_known = !convex.mesh.faces.empty();
    if (task.is_known) {
        task.network = Network(convex.mesh.positions, convex.mesh.faces);
    } else {
        begin_closed(task, make_shell(task.target(), settings, survey, progress).mesh(progress), settings);
    }
}

/// By the shell of the points, or one layer through them.
void begin_by_points(LearningTask& task, const Settings& settings, Survey& survey, Progress& progress) {
    PartOf closing(progress, 0, kShellMade);
    PartOf opening(progress, kShellMade, 1);
    const Shell shell = make_shell(task.target(), settings, survey, closing);
    const Enclosure& enclosure = shell.enclosure();
    std::optional<ConvexSurface> convex;
    const std::size_t points = task.target().positions().size();
    const bool few = points <= std::min(kFewPoints, static_cast<std::size_t>(settings.target_vertices));
    if (!task.target().has_faces() && (few || !enclosure.encloses_space))
        convex = convex_surface(task.target(), settings.target_vertices, settings.surface == kClosedSurface);
    const bool may_open =
        settings.surface == kAutomatic && may_be_open(enclosure, task.target(), settings, 0);
    std::optional<OpenStart> start;
    if (may_open || !enclosure.encloses_space)
        start = try_open_start(task, enclosure, convex.has_value(), settings, survey, opening);
    if (start) {
        begin_open(task, std::move(*start), settings);
    } else if (convex) {
        begin_convex(task, std::move(*convex), settings, survey, closing);
    } else {
        begin_closed(task, shell.mesh(closing), settings);
    }
}

/// Makes the start mesh.
void begin(LearningTask& task, const Settings& settings, const IndexedMesh<double>& given, Survey& survey,
           Progress& progress) {
    if (settings.start_mesh == kGivenMesh) {
        begin_given(task, given, settings);
        return;
    }
    if (settings.start_mesh == kTetrahedron) {
        if (settings.surface == kOpenSurface && !settings.learn_topology)
            task.warnings.push_back(
                "The surface is closed, because start_mesh 1 (tetrahedron) is. Choose start_mesh 0 for an "
                "open one.");
        begin_tetrahedron(task, settings);
        return;
    }
    if (settings.surface == kOpenSurface) {
        OpenStart start = make_open_start(task.target(), settings, survey, progress);
        warn_of_thin_walls(task, start.layers, "They were learned as one sheet.");
        begin_open(task, std::move(start), settings);
        return;
    }
    begin_by_points(task, settings, survey, progress);
}

}  // namespace

LearningTask points_to_learn(const TargetSpace& given, const Settings& settings) {
    Survey survey(settings);
    NoProgress progress;
    return points_to_learn(given, settings, survey, progress);
}

LearningTask prepare(const TargetSpace& given, const Settings& settings, const IndexedMesh<double>& start,
                     Progress& progress) {
    progress(0, "Start mesh: looking for outliers");
    refuse_rounding(given, settings.target_vertices);
    Survey survey(settings);
    LearningTask task = points_to_learn(given, settings, survey, progress);
    progress(0, "Start mesh: examining the points");
    Settings trusted = settings;
    trusted.use_normals = normals_serve(task, survey, settings);
    begin(task, trusted, start, survey, progress);
    if (trusted.use_normals && settings.start_mesh == kShell && task.landing_signals > 0)
        report_normals(task.network, task.target(), task.parts_faced_by_normals, task.notes, task.warnings);
    if (!task.target().has_faces()) measure_noise(task, survey, settings);
    if (settings.even_sampling && settings.utility_counter != kSignalCount && !task.target().is_exact())
        weigh_points(task, survey);
    return task;
}

}  // namespace neuralmesh
