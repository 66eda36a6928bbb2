// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/signal_stream.h"

#include <algorithm>

namespace neuralmesh {

const vcg::Point3f* SignalStream::take(int count) {
    draw_ahead(count);
    const vcg::Point3f* taken = &drawn_[begin_];
    begin_ += static_cast<std::size_t>(count);
    return taken;
}

void SignalStream::draw_ahead(int count) noexcept {
    const std::size_t wanted = begin_ + static_cast<std::size_t>(count);
    if (wanted <= end_) return;
    const std::size_t more = wanted - end_;
    if (wanted > drawn_.size()) {
        const auto from = drawn_.begin();
        std::copy(from + static_cast<std::ptrdiff_t>(begin_), from + static_cast<std::ptrdiff_t>(end_), from);
        end_ -= begin_;
        begin_ = 0;
    }
    vcg::Point3f* const first = drawn_.data() + end_;
    target_.sample_each(random_, {first, first + more});
    end_ += more;
}

}  // namespace neuralmesh
