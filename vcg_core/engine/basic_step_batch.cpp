// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/engine/basic_step_batch.h"

#include <algorithm>

namespace neuralmesh {

const std::vector<StepResult>& BasicStepBatch::take(const vcg::Point3f* signals, int count,
                                                    const StepRates& rates, Network& network,
                                                    WinnerSearch& search) {
    results_.resize(static_cast<std::size_t>(count));
    for (Slab& slab : slabs_) slab.steps.reserve(count);
    schedule_.begin_batch(count, network, search);
    const BatchInput input{signals, count, rates, network, search};
    schedule_.parallel([&](int slab) { slab_at(slab).steps.compute(input, schedule_, slab); });
    exchange_border_steps();
    schedule_.parallel([&](int slab) { apply(slab, network, search); });
    collect(search);
    schedule_.end_batch();
    return results_;
}

/// Gives every slab the steps of the others that may move its vertices, and reserves memory, as apply() must
/// not throw.
void BasicStepBatch::exchange_border_steps() {
    std::size_t moves = 0;
    for (int s = 0; s < schedule_.slabs(); ++s) moves += static_cast<std::size_t>(slab_at(s).steps.moves());
    for (int s = 0; s < schedule_.slabs(); ++s) {
        Slab& slab = slab_at(s);
        slab.cell_changes.clear();
        slab.cell_changes.reserve(moves);
        slab.border_steps.clear();
        for (int other = 0; other < schedule_.slabs(); ++other) {
            const SlabSteps& steps = slab_at(other).steps;
            for (int k = 0; other != s && k < steps.count(); ++k)
                if (!steps.inside(k)) slab.border_steps.push_back({steps.signal(k), other, k});
        }
        if (schedule_.slabs() > 2)
            std::sort(slab.border_steps.begin(), slab.border_steps.end(),
                      [](const BorderStep& a, const BorderStep& b) { return a.signal < b.signal; });
    }
}

/// Moves the vertices of \p slab by all displacements, in the order of the signals.
void BasicStepBatch::apply(int slab, const Network& network, WinnerSearch& search) {
    Slab& own = slab_at(slab);
    const auto move = [&](VertexId v, Four by) {
        search.move(v, load_xyz(&network.slots()[v]) + by, own.cell_changes);
    };
    const auto apply_step = [&](const SlabSteps& steps, int k, bool all) {
        const Four* by = steps.displacements(k);
        const VertexId winner = steps.winner(k);
        const Ring& ring = network.ring(winner);
        if (all || ring.tag == slab) move(winner, by[0]);
        for (int i = 0; i < ring.valence; ++i)
            if (all || network.ring(ring[i]).tag == slab) move(ring[i], by[1 + i]);
    };
    auto border = own.border_steps.begin();
    for (int k = 0; k < own.steps.count(); ++k) {
        for (; border != own.border_steps.end() && border->signal < own.steps.signal(k); ++border)
            apply_step(slab_at(border->slab).steps, border->index, false);
        apply_step(own.steps, k, own.steps.inside(k));
    }
    for (; border != own.border_steps.end(); ++border)
        apply_step(slab_at(border->slab).steps, border->index, false);
}

/// Puts the results of all slabs in the order of the signals and brings \p search up to date.
void BasicStepBatch::collect(WinnerSearch& search) {
    for (int s = 0; s < schedule_.slabs(); ++s) {
        const Slab& slab = slab_at(s);
        for (int k = 0; k < slab.steps.count(); ++k)
            results_[static_cast<std::size_t>(slab.steps.signal(k))] = {slab.steps.winner(k),
                                                                        slab.steps.delta(k)};
        // The order of changes does not matter: ties go to the smaller id wherever it is in its list.
        search.apply(slab.cell_changes);
    }
}

}  // namespace neuralmesh
