// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The signals of the learning, in the order in which they are drawn from the target space.
#pragma once

#include <vcg/space/point3.h>

#include <cstddef>
#include <vector>

#include "vcg_core/base/random.h"
#include "vcg_core/target/target_space.h"

namespace neuralmesh {

/// A stream of signals. How far it is drawn ahead does not change what comes out of it.
class SignalStream {
public:
    /// At most \p most signals are taken, or drawn ahead, at a time. A reference to \p target is kept.
    SignalStream(const TargetSpace& target, int random_seed, int most)
        : target_(target),
          random_(static_cast<std::uint64_t>(random_seed)),
          drawn_(2 * static_cast<std::size_t>(most)) {}

    /// The next \p count signals, valid until the next call of a member.
    const vcg::Point3f* take(int count);
    /// Sees to it that take(\p count) finds its signals drawn. Does not throw.
    void draw_ahead(int count) noexcept;

private:
    const TargetSpace& target_;
    Random random_;
    std::vector<vcg::Point3f> drawn_;
    std::size_t begin_ = 0;  ///< of those that are drawn and not taken
    std::size_t end_ = 0;
};

}  // namespace neuralmesh
