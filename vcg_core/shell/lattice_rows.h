// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Each value combined with those of the rows beside it: the passes of separable sums, maxima and distances.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "vcg_core/shell/lattice.h"

namespace neuralmesh {

/// Replaces each value v of row i by combine(v, w, i - j) for the values w at the same place of the rows j
/// within \p reach of i, for \p count rows of \p width values, \p stride apart from \p first on. \p combine
/// must not depend on the order of the rows. \p scratch is for a copy of them. O(count * width * reach).
template <class T, class Combine>
void combine_rows(T* first, int count, std::ptrdiff_t stride, int width, int reach, const Combine& combine,
                  std::vector<T>& scratch) {
    const std::ptrdiff_t w = width;
    scratch.resize(static_cast<std::size_t>(count * w));
    for (int i = 0; i < count; ++i) std::copy_n(first + i * stride, w, scratch.data() + i * w);
    for (int i = 0; i < count; ++i) {
        T* out = first + i * stride;
        for (int j = std::max(0, i - reach); j <= std::min(count - 1, i + reach); ++j) {
            if (j == i) continue;
            const T* in = scratch.data() + j * w;
            for (std::ptrdiff_t x = 0; x < w; ++x) out[x] = combine(out[x], in[x], i - j);
        }
    }
}

/// combine_rows() of all rows along x with those beside them along y, then along z.
template <class T, class Combine>
void combine_across_rows(const Lattice& l, int reach, const Combine& combine, PerNode<T>& values) {
    std::vector<T> scratch;
    const std::ptrdiff_t row = l.nx, slice = row * l.ny;
    for (int z = 0; z < l.nz; ++z)
        combine_rows(values.data() + z * slice, l.ny, row, l.nx, reach, combine, scratch);
    for (int y = 0; y < l.ny; ++y)
        combine_rows(values.data() + y * row, l.nz, slice, l.nx, reach, combine, scratch);
}

}  // namespace neuralmesh
