// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/c_api/neural_mesh.h"

#include <cmath>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "vcg_core/base/text.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/c_api/arrays.h"
#include "vcg_core/c_api/distance_search.h"
#include "vcg_core/mesh_counters.h"
#include "vcg_core/reconstruct.h"
#include "vcg_core/run_figures.h"
#include "vcg_core/settings.h"

using namespace neuralmesh;
using c_api::CallError;
using c_api::checked;
using Kind = SettingInfo::Kind;

struct neural_mesh_task {
    int kind = NEURAL_MESH_RECONSTRUCTION;
    Settings settings;
    c_api::Cloud cloud;
    neural_mesh_array mesh_positions{}, mesh_faces{};
    std::unique_ptr<c_api::DistanceSearch> search;  ///< of the given mesh, once distances were asked for
    std::string sentence;
    const char* error = "";  ///< sentence, or a constant if there is no memory for one
};

namespace {

bool is_kind(int kind) { return kind == NEURAL_MESH_RECONSTRUCTION || kind == NEURAL_MESH_COUNTERS; }

const std::vector<SettingInfo>& table_of(int kind) {
    return kind == NEURAL_MESH_COUNTERS ? counter_table() : setting_table();
}

/// Whether the parameter says which layer of a host, or which selected part of one, is meant.
bool is_of_layers(const SettingInfo& info) {
    return info.kind == Kind::layer || info.member == SettingInfo::Member(&Settings::selected_only);
}

// --- Parameters ------------------------------------------------------------------------------------

static_assert(int(Kind::boolean) == NEURAL_MESH_BOOLEAN && int(Kind::integer) == NEURAL_MESH_INTEGER &&
              int(Kind::real) == NEURAL_MESH_REAL && int(Kind::length) == NEURAL_MESH_LENGTH &&
              int(Kind::choice) == NEURAL_MESH_CHOICE);

/// The rows of a table of the core as C knows them.
struct ParameterTable {
    explicit ParameterTable(const std::vector<SettingInfo>& table) {
        const Settings defaults;
        for (const SettingInfo& info : table) {
            if (is_of_layers(info)) continue;
            std::vector<const char*>& choice = choices.emplace_back();
            for (const std::string& name : info.choices) choice.push_back(name.c_str());
            rows.push_back({info.id, info.label, info.help, static_cast<int>(info.kind), info.low, info.high,
                            info.value(defaults), choice.size(), choice.data()});
        }
    }
    std::vector<neural_mesh_parameter> rows;
    std::vector<std::vector<const char*>> choices;  ///< moving a vector leaves its elements where they are
};

const ParameterTable& parameters_of(int kind) {
    static const ParameterTable reconstruction(setting_table());
    static const ParameterTable counters(counter_table());
    return kind == NEURAL_MESH_COUNTERS ? counters : reconstruction;
}

[[noreturn]] void refuse_name(const std::string& name, int kind) {
    std::string names;
    for (const neural_mesh_parameter& parameter : parameters_of(kind).rows)
        names += (names.empty() ? "" : ", ") + std::string(parameter.name);
    throw SettingError("There is no parameter " + name + ". The parameters are " + names + '.');
}

const SettingInfo& row_of(const std::string& name, int kind) {
    for (const SettingInfo& info : table_of(kind))
        if (name == info.id && !is_of_layers(info)) return info;
    refuse_name(name, kind);
}

/// Whether the value has the kind of the parameter. Its range is checked later, but for integers beyond int.
bool has_kind(const SettingInfo& info, double value) {
    if (info.kind == Kind::boolean) return value == 0 || value == 1;
    if (info.kind == Kind::real || info.kind == Kind::length) return true;
    const double beyond_int = 2147483648.0;
    return std::abs(value) < beyond_int && value == std::floor(value);
}

void set_parameter(neural_mesh_task& task, const std::string& name, double value) {
    const SettingInfo& info = row_of(name, task.kind);
    if (!has_kind(info, value)) {
        std::ostringstream text = stream_with(12);
        text << "The parameter " << name << " (" << info.label << ") is " << value
             << ": give a whole number from " << info.low << " to " << info.high << '.';
        throw SettingError(text.str());
    }
    Settings changed = task.settings;
    info.store(changed, value);
    changed.check({info});
    task.settings = changed;
}

// --- Errors ----------------------------------------------------------------------------------------

int failed(neural_mesh_task& task, int status, std::string sentence) {
    task.sentence = std::move(sentence);
    task.error = task.sentence.c_str();
    return status;
}

/// The status of the exception that is being handled, with its sentence in \p task.
int failed_by_exception(neural_mesh_task& task) {
    try {
        throw;
    } catch (const CallError& error) {
        return failed(task, NEURAL_MESH_WRONG_CALL, error.what());
    } catch (const SettingError& error) {
        return failed(task, NEURAL_MESH_WRONG_PARAMETER, error.what());
    } catch (const Error& error) {
        return failed(task, NEURAL_MESH_WRONG_INPUT, error.what());
    } catch (const std::bad_alloc&) {
        task.error = "There is not enough memory for this mesh: take fewer vertices, or a smaller cloud.";
        return NEURAL_MESH_NO_MEMORY;
    } catch (const std::exception& error) {
        return failed(task, NEURAL_MESH_UNEXPECTED,
                      std::string("The library met an unexpected error (") + error.what() +
                          "). Please report it with the input and the parameters.");
    }
}

/// Calls \p work and turns what it throws into a status.
template <class Work>
int guarded(neural_mesh_task* task, const Work& work) noexcept {
    if (task == nullptr) return NEURAL_MESH_WRONG_CALL;
    task->error = "";
    try {
        try {
            work();
            return NEURAL_MESH_OK;
        } catch (...) {
            return failed_by_exception(*task);
        }
    } catch (const std::bad_alloc&) {
        task->error = "There is not enough memory.";
        return NEURAL_MESH_NO_MEMORY;
    } catch (...) {
        task->error = "The library met an unknown error. Please report it with the input and the parameters.";
        return NEURAL_MESH_UNEXPECTED;
    }
}

// --- Runs ------------------------------------------------------------------------------------------

class CallersProgress : public Progress {
public:
    CallersProgress(neural_mesh_progress call, void* context) : call_(call), context_(context) {}
    bool operator()(double fraction, const char* text) override {
        return call_ == nullptr || call_(context_, fraction, text) != 0;
    }

private:
    neural_mesh_progress call_;
    void* context_;
};

template <class T>
auto data_or_null(const std::vector<T>& values) {
    return values.empty() ? nullptr : values.data();
}

/// What the caller sees, and what it points into.
struct StoredResult : neural_mesh_result {
    StoredResult() : neural_mesh_result{} {}

    void take(NeuralMesh learned) {
        mesh = std::move(learned);
        vertex_count = mesh.positions.size();
        face_count = mesh.faces.size();
        positions = mesh.positions.empty() ? nullptr : mesh.positions.front().V();
        faces = mesh.faces.empty() ? nullptr : mesh.faces.front().data();
        colors = mesh.colors.empty() ? nullptr : mesh.colors.front().data();
        const CreaseLines& lines = mesh.creases;
        crease_vertex_count = lines.positions.size();
        crease_edge_count = lines.edges.size();
        crease_positions = lines.positions.empty() ? nullptr : lines.positions.front().V();
        crease_edges = lines.edges.empty() ? nullptr : lines.edges.front().data();
        crease_quality = data_or_null(lines.measures);
        take_values(figures_of_reconstruction(mesh.report));
    }

    void take(MeshCounters counted) {
        mesh.counters = std::move(counted.counters);
        mesh.features = std::move(counted.features);
        mesh.report = std::move(counted.report);
        vertex_count = mesh.counters.size();
        take_values(figures_of_counters(mesh.report));
    }

private:
    void take_values(const std::vector<Figure>& all) {
        quality = data_or_null(mesh.counters);
        features = reinterpret_cast<const unsigned char*>(data_or_null(mesh.features));
        for (const Figure& figure : all)
            stored_figures.push_back({figure.key, figure.value, figure.is_count ? 1 : 0});
        figure_count = stored_figures.size();
        neural_mesh_result::figures = stored_figures.data();
        for (const std::string& note : mesh.report.notes)
            stored_messages.push_back({NEURAL_MESH_NOTE, note.c_str()});
        for (const std::string& warning : mesh.report.warnings)
            stored_messages.push_back({NEURAL_MESH_WARNING, warning.c_str()});
        message_count = stored_messages.size();
        messages = data_or_null(stored_messages);
    }

    static_assert(sizeof(vcg::Point3d) == 3 * sizeof(double) && sizeof(Color) == 3, "rows without gaps");
    NeuralMesh mesh;
    std::vector<neural_mesh_figure> stored_figures;
    std::vector<neural_mesh_message> stored_messages;
};

void reconstruct_cloud(const neural_mesh_task& task, Progress& progress, StoredResult& result) {
    const Settings& settings = task.settings;
    settings.check();
    IndexedMesh<double> start;
    if (settings.start_mesh == kGivenMesh) {
        if (task.mesh_faces.rows == 0)
            throw InputError("Learning is to start from a given mesh (start_mesh), but none is given.");
        start = c_api::indexed_mesh_of(task.mesh_positions, task.mesh_faces);
    }
    result.take(reconstruct(c_api::target_space_of(task.cloud, settings), settings, progress, start));
}

void count_mesh(const neural_mesh_task& task, Progress& progress, StoredResult& result) {
    Settings settings = task.settings;
    settings.check(counter_table());
    settings.use_normals = false;
    settings.vertex_color = kNoColors;
    c_api::Cloud cloud = task.cloud;
    if (cloud.points.rows == 0) cloud = {task.mesh_positions, {}, {}, task.mesh_faces};
    const IndexedMesh<double> mesh = c_api::indexed_mesh_of(task.mesh_positions, task.mesh_faces);
    result.take(mesh_counters(mesh, c_api::target_space_of(cloud, settings), settings, progress));
}

}  // namespace

int neural_mesh_abi(void) { return NEURAL_MESH_ABI; }

const char* neural_mesh_version(void) { return NEURALMESH_VERSION; }

const neural_mesh_parameter* neural_mesh_parameters(int kind, size_t* count) {
    if (count != nullptr) *count = 0;
    if (count == nullptr || !is_kind(kind)) return nullptr;
    try {
        const ParameterTable& table = parameters_of(kind);
        *count = table.rows.size();
        return table.rows.data();
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}

neural_mesh_task* neural_mesh_new(int kind) {
    if (!is_kind(kind)) return nullptr;
    auto* const task = new (std::nothrow) neural_mesh_task;
    if (task != nullptr) task->kind = kind;
    return task;
}

void neural_mesh_free(neural_mesh_task* task) { delete task; }

const char* neural_mesh_error(const neural_mesh_task* task) {
    return task == nullptr ? "There is no task." : task->error;
}

int neural_mesh_set(neural_mesh_task* task, const char* name, double value) {
    return guarded(task, [&] {
        if (name == nullptr) throw CallError("The name of the parameter is missing.");
        set_parameter(*task, name, value);
    });
}

int neural_mesh_set_points(neural_mesh_task* task, const neural_mesh_array* points) {
    return guarded(task, [&] {
        task->cloud.points = checked(points, "points", {NEURAL_MESH_FLOAT, NEURAL_MESH_DOUBLE});
    });
}

int neural_mesh_set_colors(neural_mesh_task* task, const neural_mesh_array* colors) {
    return guarded(task, [&] { task->cloud.colors = checked(colors, "colours", {NEURAL_MESH_BYTE}); });
}

int neural_mesh_set_normals(neural_mesh_task* task, const neural_mesh_array* normals) {
    return guarded(task, [&] {
        task->cloud.normals = checked(normals, "normals", {NEURAL_MESH_FLOAT, NEURAL_MESH_DOUBLE});
    });
}

int neural_mesh_set_faces(neural_mesh_task* task, const neural_mesh_array* faces) {
    return guarded(task, [&] {
        task->cloud.faces = checked(faces, "faces", {NEURAL_MESH_INT32, NEURAL_MESH_INT64});
    });
}

int neural_mesh_set_mesh(neural_mesh_task* task, const neural_mesh_array* positions,
                         const neural_mesh_array* faces) {
    return guarded(task, [&] {
        const neural_mesh_array corners = checked(faces, "faces", {NEURAL_MESH_INT32, NEURAL_MESH_INT64});
        task->mesh_positions = checked(positions, "positions", {NEURAL_MESH_FLOAT, NEURAL_MESH_DOUBLE});
        task->mesh_faces = corners;
        task->search.reset();
    });
}

int neural_mesh_run(neural_mesh_task* task, neural_mesh_progress progress, void* context,
                    const neural_mesh_result** result) {
    if (result != nullptr) *result = nullptr;
    return guarded(task, [&] {
        if (result == nullptr) throw CallError("There is no place for the result.");
        CallersProgress reports(progress, context);
        auto made = std::make_unique<StoredResult>();
        (task->kind == NEURAL_MESH_COUNTERS ? count_mesh : reconstruct_cloud)(*task, reports, *made);
        *result = made.release();
    });
}

int neural_mesh_distances(neural_mesh_task* task, const neural_mesh_array* points, double* distances) {
    return guarded(task, [&] {
        const neural_mesh_array given = checked(points, "points", {NEURAL_MESH_FLOAT, NEURAL_MESH_DOUBLE});
        if (distances == nullptr) throw CallError("There is no place for the distances.");
        ThreadTeam team(thread_count(task->settings.threads));
        if (task->search == nullptr)
            task->search = std::make_unique<c_api::DistanceSearch>(
                c_api::indexed_mesh_of(task->mesh_positions, task->mesh_faces), team);
        task->search->measure(given, team, distances);
    });
}

void neural_mesh_free_result(const neural_mesh_result* result) {
    delete static_cast<const StoredResult*>(result);
}
