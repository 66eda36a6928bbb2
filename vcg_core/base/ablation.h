// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Stages of the reconstruction that a development build can skip by name, to measure what each of them brings
// (tests/experiments/accuracy/ablation.py). In other builds nothing is skipped, and no code is made for it.
#pragma once

#ifdef NEURALMESH_ABLATION
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <mutex>
#include <set>
#include <sstream>
#include <string>

#include "vcg_core/base/error.h"
#endif

namespace neuralmesh {

/// The names that NEURALMESH_SKIP may hold. Each is asked for at one place, where the stage begins.
inline constexpr const char* kStages[] = {
    // the cloud
    "lifted_points", "clumps", "lattice_outliers", "even_sampling", "noise_by_place",
    // the start mesh
    "walled", "thickening", "finer_start", "hollows", "wide_lattice", "fringe", "coarser_lattices",
    "short_handles",
    // learning
    "brief_learning", "settling_surplus", "saturation", "boundary_faces", "learned_notches",
    // topology
    "membrane_groups", "wide_membranes",
    // the fit
    "strays", "cut_faces", "volume_reduction", "dense_collapses", "hold", "crease_moves", "boundary_targets",
    "notches", "webs", "held_out", "refine"};

#ifdef NEURALMESH_ABLATION

/// The names in the environment variable NEURALMESH_SKIP, which commas separate. \throws SettingError if one
/// is not in kStages
inline std::set<std::string> skipped_stages() {
    const char* names = std::getenv("NEURALMESH_SKIP");
    std::istringstream text(names == nullptr ? "" : names);
    std::set<std::string> skipped;
    for (std::string name; std::getline(text, name, ',');) {
        if (std::find(std::begin(kStages), std::end(kStages), name) == std::end(kStages))
            throw SettingError("NEURALMESH_SKIP names the stage \"" + name +
                               "\", which does not exist: vcg_core/base/ablation.h lists those there are.");
        skipped.insert(name);
    }
    return skipped;
}

/// The stages that were asked for. When the process ends their names are written to the file that the
/// environment variable NEURALMESH_ASKED names, if it is set: skipping any other would change nothing.
class AskedStages {
public:
    ~AskedStages() {
        const char* file = std::getenv("NEURALMESH_ASKED");
        if (file == nullptr) return;
        std::ofstream out(file);
        for (const std::string& name : names_) out << name << '\n';
    }
    void add(const char* name) {
        const std::lock_guard<std::mutex> lock(mutex_);
        names_.insert(name);
    }

private:
    std::mutex mutex_;
    std::set<std::string> names_;
};

/// Whether NEURALMESH_SKIP, as it was at the first call, names the stage \p name.
inline bool skips(const char* name) {
    static const std::set<std::string> skipped = skipped_stages();
    static AskedStages asked;
    asked.add(name);
    return skipped.count(name) > 0;
}

#else

constexpr bool skips(const char*) { return false; }

#endif

}  // namespace neuralmesh
