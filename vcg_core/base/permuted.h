// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Per-vertex values after a renumbering.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "vcg_core/base/indexed.h"

namespace neuralmesh {

/// \p values permuted: result[i] = values[order[i]]. Keeps the capacity that \p values has reserved for
/// growth.
template <class T>
Indexed<T> permuted(const Indexed<T>& values, const std::vector<std::int32_t>& order) {
    Indexed<T> result;
    result.reserve(static_cast<int>(std::max(values.vector().capacity(), order.size())));
    for (const std::int32_t i : order) result.push_back(values[i]);
    return result;
}

}  // namespace neuralmesh
