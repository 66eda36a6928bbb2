// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The sequence of signals of a learning run.
#pragma once

#include <vcg/space/point3.h>

#include <cstddef>
#include <vector>

#include "vcg_core/base/random.h"
#include "vcg_core/cloud/target_space.h"

namespace neuralmesh {

/// Signals drawn from a target space. Drawing ahead does not change the sequence.
class SignalStream {
public:
    /// \p most is the upper limit of the counts below. Keeps a reference to \p target.
    SignalStream(const TargetSpace& target, int random_seed, int most)
        : target_(target),
          random_(stream_seed(random_seed, Stream::learning)),
          drawn_(2 * static_cast<std::size_t>(most)) {}

    /// The next \p count signals. The pointer is valid until the next call of a member function.
    const vcg::Point3f* take(int count);
    /// Draws the signals that the next take(\p count) will return, possibly in another thread.
    void draw_ahead(int count) noexcept;

private:
    const TargetSpace& target_;
    Random random_;
    std::vector<vcg::Point3f> drawn_;
    std::size_t begin_ = 0;  ///< [begin_, end_): drawn but not yet taken
    std::size_t end_ = 0;
};

}  // namespace neuralmesh
