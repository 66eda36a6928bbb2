// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/learn_to_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "vcg_core/base/error.h"
#include "vcg_core/base/median.h"
#include "vcg_core/base/text.h"
#include "vcg_core/error_search.h"
#include "vcg_core/fit/rms_error.h"
#include "vcg_core/target/surface_survey.h"

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
    /// Root mean square of the distances from \p mesh, without the noise, in the units of the input.
    double error_of(const NeuralMesh& mesh) {
        std::vector<Point3f> positions;
        for (const vcg::Point3d& p : mesh.positions) positions.push_back(given_.frame().inside(p));
        const Network network(positions, mesh.faces);
        const double distance = rms_distance(held_out_, {}, network, team_);
        const double squared = distance * distance - squared_noise_;
        return std::sqrt(std::max(squared, kUnknownShare * squared_noise_)) * given_.frame().diagonal;
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

}  // namespace

NeuralMesh learn_to_error(const TargetSpace& given, const Settings& settings, Progress& progress,
                          const Learn& learn) {
    constexpr int kLeast = 4;
    constexpr double kShare = 0.4;  // of the progress that is left, for a trial
    Examination examination(given, settings);
    Settings trial = settings;
    if (examination.held_out() == 0) return learn(given, trial, progress);
    MonotoneProgress monotone(progress);
    ErrorSearch search(settings.target_error, kLeast, settings.target_vertices);
    std::map<int, NeuralMesh> meshes;  // by vertices asked for
    double done = 0;
    while ((trial.target_vertices = search.next()) != 0) {
        PartOf part(monotone, done, done + kShare * (1 - done));
        done += kShare * (1 - done);
        try {
            NeuralMesh mesh = learn(examination.learned(), trial, part);
            if (monotone.stopped()) return mesh;
            search.add(trial.target_vertices, examination.error_of(mesh));
            meshes.emplace(trial.target_vertices, std::move(mesh));
        } catch (const SettingError&) {  // too few for the components and handles
            if (trial.target_vertices == settings.target_vertices) throw;
            search.too_few(trial.target_vertices);
        }
    }
    NeuralMesh mesh = std::move(meshes.at(search.best().vertices));
    report(search, settings, examination, mesh.report);
    return mesh;
}

}  // namespace neuralmesh
