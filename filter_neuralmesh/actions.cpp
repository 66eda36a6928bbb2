// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "actions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <locale>
#include <new>
#include <sstream>

#include "vcg_core/base/error.h"

namespace neuralmesh {

namespace {

constexpr const char* kReconstructInfo =
    "Reconstructs the surface of a point cloud as a triangle mesh with exactly the given number of vertices, "
    "dense where the surface bends and sparse where it is flat. The points need no normals and may be noisy "
    "and unevenly spaced. A growing neural network learns the cloud: a random point attracts the nearest "
    "vertex, vertices whose normal varies much are split, vertices that never win are collapsed.<br/>"
    "The current layer is not changed. The result is a new layer in world coordinates; if those exceed "
    "single precision, it has the translation of the current layer in its matrix. The vertex quality is what "
    "'Feature measure' names: near zero on smooth parts, large on edges and corners. The vertex colours are "
    "those of the layer, or show the quality if it has none.<br/>"
    "See:<br/>"
    "<i>Won-Ki Jeong, Ioannis Ivrissimtzis, Hans-Peter Seidel</i><br/>"
    "<b>\"Neural Meshes: Statistical Learning based on Normals\"</b><br/>"
    "Pacific Graphics 2003<br/>";

constexpr const char* kCountersInfo =
    "Computes how much of a feature each vertex of the current mesh is: near zero on smooth parts, large on "
    "edges and corners, also where the points or the mesh are noisy. A copy of the mesh learns random points "
    "of the signal layer, and the normals of its vertices tell how the surface bends there.<br/>"
    "The mesh may come from any filter. Only its vertex quality changes and, with 'Select features', the "
    "selection of its vertices. It has to be an oriented manifold, with or without boundary; vertices that "
    "belong to no face get 0.<br/>"
    "See:<br/>"
    "<i>Won-Ki Jeong, Ioannis Ivrissimtzis, Hans-Peter Seidel</i><br/>"
    "<b>\"Neural Meshes: Statistical Learning based on Normals\"</b><br/>"
    "Pacific Graphics 2003<br/>";

const char* words_for(StopReason reason) {
    switch (reason) {
        case StopReason::target_reached: return "the target was reached";
        case StopReason::converged:
            return "signals turned the normals by fewer degrees than 'Stop below mean counter'";
        case StopReason::cancelled: return "it was cancelled";
        case StopReason::cut_short: return "the limit on signals was reached before the target";
    }
    return "";
}

/// A stream that writes decimal points, whatever locale the host has set.
std::ostringstream plain_stream() {
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    return stream;
}

/// The words of a progress text before its first number.
std::string stage_of(const std::string& text) { return text.substr(0, text.find_first_of("0123456789")); }

const char* words_for_confidence(double confidence) {
    if (confidence < 0.5) return "low: check the mesh";
    if (confidence < 0.9) return "fair";
    return "high, except for details finer than the spacing of the points";
}

std::string sentence_on_topology(const Report& report) {
    std::ostringstream text = plain_stream();
    text << "The surface was found to have " << report.components
         << (report.components == 1 ? " component" : " components") << " and " << report.genus
         << (report.genus == 1 ? " handle" : " handles") << ", with a confidence of "
         << std::lround(100 * report.topology_confidence) << " % ("
         << words_for_confidence(report.topology_confidence) << ").";
    return text.str();
}

std::string sentence_on_run(const Report& report, int action) {
    std::ostringstream text = plain_stream();
    text << std::fixed << std::setprecision(2);
    if (action == kCounters) {
        text << "Neural Normal Counter: " << report.vertices << " vertices after " << report.signals
             << " signals in " << report.seconds << " seconds, mean " << report.mean_counter
             << (report.stop_reason == StopReason::cancelled ? "; it was cancelled." : ".");
        return text.str();
    }
    text << "Neural Mesh: " << report.vertices << " vertices and " << report.faces << " faces after "
         << report.signals << " signals in " << report.seconds << " seconds, RMS error "
         << std::setprecision(4) << report.rms_error << " % of the diagonal; learning ended because "
         << words_for(report.stop_reason) << '.';
    return text.str();
}

std::string message(const char* kind, std::string sentence) {
    std::replace(sentence.begin(), sentence.end(), '\n', ' ');
    return std::string(kind) + '\t' + sentence + '\n';
}

std::string sentence_if_memory_allows() {
    try {
        throw;
    } catch (const Error& error) {
        return error.what();
    } catch (const std::bad_alloc&) {
        return "There is not enough memory for this mesh: take fewer vertices, or a smaller cloud.";
    } catch (const std::exception& error) {
        return std::string("The filter met an unexpected error and has changed nothing (") + error.what() +
               "). Please report it with the layer and the parameters.";
    } catch (...) {
        return "The filter met an unknown error and has changed nothing. Please report it with the layer and "
               "the parameters.";
    }
}

}  // namespace

const std::vector<Action>& all_actions() {
    static const std::vector<Action> all = {
        {kReconstruct, "Surface Reconstruction: Neural Mesh", "generate_surface_reconstruction_neural_mesh",
         kReconstructInfo, setting_table()},
        {kCounters, "Compute Scalar by Neural Normal Counter",
         "compute_scalar_by_neural_normal_counter_per_vertex", kCountersInfo, counter_table()}};
    return all;
}

const Action& action_of(int id) { return all_actions().at(static_cast<std::size_t>(id)); }

std::vector<Figure> figures(const Report& report, int action) {
    return action == kCounters ? figures_of_counters(report) : figures_of_reconstruction(report);
}

std::vector<std::string> log_lines(const Report& report, int action) {
    std::ostringstream dictionary = plain_stream();
    dictionary << std::setprecision(9);
    for (const Figure& figure : figures(report, action)) {
        dictionary << figure.key << '=';
        if (figure.is_count) {
            dictionary << static_cast<long long>(figure.value) << ' ';
        } else {
            dictionary << figure.value << ' ';
        }
    }

    std::vector<std::string> lines = {sentence_on_run(report, action), dictionary.str()};
    if (report.topology_confidence > 0) lines.push_back(sentence_on_topology(report));
    return lines;
}

std::string messages_of(const Report& report, int action) {
    std::string lines = message("note", sentence_on_run(report, action));
    if (report.topology_confidence > 0) lines += message("note", sentence_on_topology(report));
    for (const std::string& note : report.notes) lines += message("note", note);
    for (const std::string& warning : report.warnings) lines += message("warning", warning);
    return lines;
}

std::string message_of_error(const std::string& sentence) { return message("error", sentence); }

std::string sentence_on_origin(const Coordinates& origin) {
    std::ostringstream text = plain_stream();
    text << std::setprecision(9)
         << "World coordinates exceed single precision here. So the new layer has the translation ("
         << origin[0] << ", " << origin[1] << ", " << origin[2]
         << ") in its matrix, like the layer it was learned from, and stores coordinates relative to it. "
         << "MeshLab and project files show it in its place; a mesh file has no matrix and holds the "
         << "relative coordinates.";
    return text.str();
}

double from_host(double value) {
    // Not by std::to_chars(), which older C++ libraries lack for floating-point numbers.
    constexpr int kDigits = std::numeric_limits<float>::max_digits10;
    const auto rounded = static_cast<float>(value);
    for (int digits = 1; digits <= kDigits; ++digits) {
        std::stringstream text;
        text.imbue(std::locale::classic());
        double meant = 0;
        text << std::setprecision(digits) << rounded;
        if (text >> meant && static_cast<float>(meant) == rounded) return meant;
    }
    return value;  // not finite
}

std::string sentence_of_current_exception() {
    try {
        return sentence_if_memory_allows();
    } catch (const std::bad_alloc&) {
        return "Out of memory.";  // short enough to need no allocation
    }
}

bool HostProgress::operator()(double fraction, const char* text) {
    if (call_back_ == nullptr) return true;
    const auto now = std::chrono::steady_clock::now();
    std::string stage = stage_of(text);
    if (stage == stage_ && now - last_call_ < std::chrono::milliseconds(100)) return true;
    stage_ = std::move(stage);
    last_call_ = now;
    return call_back_(static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0)), text);
}

}  // namespace neuralmesh
