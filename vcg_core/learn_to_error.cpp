// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/learn_to_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "vcg_core/base/error.h"
#include "vcg_core/base/median.h"
#include "vcg_core/base/text.h"
#include "vcg_core/cloud/surface_survey.h"
#include "vcg_core/error_search.h"
#include "vcg_core/fit/point_errors.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

/// Enough for an error within 2 % by chance; a twentieth of the cloud is hardly missed.
constexpr std::size_t kMostHeldOut = 5000, kCloudPerHeldOut = 20;
/// The deviation of the noise is known within 5 %, its square within 10 %: an error below a third of the
/// deviation cannot be told.
constexpr double kUnknownShare = 0.1;

/// What is learned, and the points by which the mesh is judged.
class Examination {
public:
    Examination(const TargetSpace& given, const Settings& settings)
        : given_(given), team_(thread_count(settings.threads)) {
        Random random(stream_seed(settings.random_seed, Stream::held_out));
        if (given.is_exact()) {
            while (held_out_.size() < kMostHeldOut) hold_out(given.sample(random));
        } else {
            split(random, settings.threads);
        }
    }
    const TargetSpace& learned() const { return rest_ ? *rest_ : given_; }
    std::size_t held_out() const { return held_out_.size(); }
    /// In the units of the input.
    double noise() const { return std::sqrt(squared_noise_) * given_.frame().diagonal; }
    /// Root mean square of the distances from \p network, which lies in \p frame, without the noise, in the
    /// units of the input.
    double error_of(const Network& network, const Frame& frame) {
        std::vector<Vector3> points;
        for (const Vector3& p : held_out_)
            points.push_back(to_eigen(frame.inside(given_.frame().outside(to_vcg(p)))));
        const double distance = rms_distance(points, {}, network, team_) * frame.diagonal;
        const double squared_noise = noise() * noise();
        return std::sqrt(std::max(distance * distance - squared_noise, kUnknownShare * squared_noise));
    }

private:
    void hold_out(const Point3f& p) { held_out_.push_back(to_eigen(p)); }

    void split(Random& random, int threads) {
        Surveys surveys(given_.positions(), threads);
        const NearestPoints& cloud = surveys.points().cloud;
        const std::size_t wanted = std::min(kMostHeldOut, cloud.size() / kCloudPerHeldOut);
        std::vector<std::uint8_t> out(cloud.size(), 0);
        std::vector<float> deviations;
        for (std::size_t i = 0; i < wanted; ++i) {
            const NearestPoints::Place place = random.below(cloud.size());
            const std::size_t index = cloud.index(place);
            if (out[index] != 0) continue;
            out[index] = 1;
            const SurveyedPlace& around = surveys.surface().at(cloud.point(place));
            if (around.clutter || lies_apart(cloud, place, around)) continue;
            hold_out(cloud.point(place));
            deviations.push_back(around.two_layers() ? 0 : around.deviation);
        }
        rest_ = given_.without(out);
        if (!rest_) held_out_.clear();
        if (held_out_.empty()) return;
        rest_->set_rounding(given_.rounding());
        // The median: at creases the deviation is that of the surface.
        const auto middle = static_cast<double>(median(std::move(deviations)));
        squared_noise_ = middle * middle;
    }

    /// An outlier is no measure of the surface.
    static bool lies_apart(const NearestPoints& cloud, NearestPoints::Place place,
                           const SurveyedPlace& around) {
        std::vector<NearestPoints::Neighbour> near;
        cloud.nearest(place, CloudSurvey::kNeighbour, near);
        const float far = kLeastDeviations * (around.spacing + around.deviation);
        return near.back().squared_distance > far * far;
    }

    const TargetSpace& given_;
    std::optional<TargetSpace> rest_;
    ThreadTeam team_;
    std::vector<Vector3> held_out_;  ///< in the frame of given_
    double squared_noise_ = 0;       ///< the same
};

std::string number(double value) {
    std::ostringstream text = stream_with(3);
    text << value;
    return text.str();
}

void report(const ErrorSearch& search, const Settings& settings, const Examination& examination,
            Report& report) {
    const ErrorSearch::Trial best = search.best();
    report.held_out_error = best.error;
    const std::string measured = "Points that were held out lie " + number(best.error) +
                                 " from the mesh of " + std::to_string(best.vertices) +
                                 " vertices (RMS, less their noise of " + number(examination.noise()) + ")";
    if (search.reached()) {
        report.notes.push_back(measured + ", as target_error asks for.");
    } else if (search.levels_off()) {
        report.warnings.push_back(
            measured + ", more than the target_error of " + number(settings.target_error) +
            ". More vertices hardly lower it: the noise or the number of the points does not "
            "allow less.");
    } else {
        report.warnings.push_back(measured + ", more than the target_error of " +
                                  number(settings.target_error) +
                                  ". Raise target_vertices, which is the most that the mesh may have.");
    }
}

/// A start mesh serves up to so many times the vertices that it was made for.
constexpr int kServes = 10;

/// Meshes of several numbers of vertices.
class Trials {
public:
    /// Keeps references.
    Trials(const Settings& settings, const OuterStages& stages, Examination& examination)
        : settings_(settings), stages_(stages), examination_(examination) {}

    /// Learns \p vertices, or reduces a mesh of more. \return the error \throws what OuterStages::prepare
    /// throws; SettingError if the components and handles of the cloud need more, and there may be more
    double learn(int vertices, Progress& progress) {
        MonotoneProgress monotone(progress);
        const auto finer = meshes_.lower_bound(vertices);
        if (finer != meshes_.end() && settings_.redistributes_vertices()) {
            const Run& run = *finer->second.run;
            check(run.task, vertices);
            return add(vertices, {&run, run.learning.reduced(finer->second.learned, vertices, monotone)});
        }
        if (runs_.empty() || vertices > kServes * runs_.back().made_for) prepare(vertices, monotone);
        Run& run = runs_.back();
        return add(vertices, {&run, run.learning.with(vertices, monotone)});
    }
    NeuralMesh finish(int vertices) const {
        const Mesh& mesh = meshes_.at(vertices);
        return stages_.finish(mesh.run->task, mesh.learned);
    }

private:
    struct Run {
        Run(LearningTask the_task, const Settings& settings)
            : task(std::move(the_task)), learning(task, settings), made_for(settings.target_vertices) {}
        LearningTask task;
        Learning learning;
        int made_for;  ///< vertices
    };
    struct Mesh {
        const Run* run;
        LearnedNetwork learned;
    };

    void check(const LearningTask& task, int vertices) const {
        if (vertices < std::min(task.vertices_needed, settings_.target_vertices))
            throw SettingError("The components and handles of the cloud need more vertices.");
    }
    double add(int vertices, Mesh mesh) {
        const double error = examination_.error_of(mesh.learned.network, mesh.run->task.target().frame());
        meshes_.insert_or_assign(vertices, std::move(mesh));
        return error;
    }

    void prepare(int vertices, Progress& progress) {
        Settings settings = settings_;
        settings.target_vertices = vertices;
        PartOf preparing(progress, 0, kPrepared);
        LearningTask task = stages_.prepare(examination_.learned(), settings, preparing);
        check(task, vertices);
        runs_.emplace_back(std::move(task), settings);
    }

    const Settings& settings_;
    const OuterStages& stages_;
    Examination& examination_;
    std::list<Run> runs_;         ///< the last has the start mesh for the most vertices
    std::map<int, Mesh> meshes_;  ///< by vertices
};

}  // namespace

NeuralMesh learn_to_error(const TargetSpace& given, const Settings& settings, Progress& progress,
                          const OuterStages& stages) {
    constexpr int kLeast = 4;       // those of a tetrahedron
    constexpr double kShare = 0.4;  // of the progress that is left, for a trial
    Examination examination(given, settings);
    MonotoneProgress monotone(progress);
    Trials trials(settings, stages, examination);
    if (examination.held_out() == 0) {
        trials.learn(settings.target_vertices, monotone);
        return trials.finish(settings.target_vertices);
    }
    ErrorSearch search(settings.target_error, kLeast, settings.target_vertices);
    double done = 0;
    while (const int vertices = search.next()) {
        PartOf part(monotone, done, done + kShare * (1 - done));
        done += kShare * (1 - done);
        try {
            const double error = trials.learn(vertices, part);
            if (monotone.stopped()) return trials.finish(vertices);
            search.add(vertices, error);
        } catch (const SettingError&) {  // too few for the components and handles
            if (vertices == settings.target_vertices) throw;
            search.too_few(vertices);
        }
    }
    NeuralMesh mesh = trials.finish(search.best().vertices);
    report(search, settings, examination, mesh.report);
    return mesh;
}

}  // namespace neuralmesh
