// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/paper/counters.h"

namespace neuralmesh {

void UtilityCounters::resize(int slots) {
    counters_.resize(slots);
    wins_.resize(slots, 0);
    tournament_.resize(slots);
}

void UtilityCounters::win(VertexId w, double amount) {
    counters_.add(w, amount);  // eq 4: the winner's counter ...
    counters_ *= alpha_nc_;    // eq 4: ... and the decay of all counters
    if (++wins_[w] >= maturity_) tournament_.set(w, counters_.key(w));
}

void UtilityCounters::share(VertexId v, VertexId u, double f_v, double f_u) {
    const double sum = f_v + f_u;
    counters_.divide(v, u, sum > 0 ? f_v / sum : 0.5);  // by F_v of eq 5
    for (const VertexId w : {v, u}) {
        wins_[w] = 0;
        tournament_.set(w, maturity_ == 0 ? counters_.key(w) : Tournament::kNone);
    }
}

void UtilityCounters::remove(VertexId v) {
    counters_.set_zero(v);
    wins_[v] = 0;
    tournament_.set(v, Tournament::kNone);
}

void UtilityCounters::renumber(const std::vector<VertexId>& order) {
    counters_.renumber(order);
    wins_ = permuted(wins_, order, std::int32_t{0});
    tournament_.renumber(order);
}

void UtilityCounters::waive_maturity() {
    maturity_ = 0;
    for (VertexId v = 0; v < counters_.size(); ++v)
        if (counters_.key(v) != ScaledNumbers::kZero) tournament_.set(v, counters_.key(v));
}

double squared_mean_edge(const Network& network, VertexId v) {
    const vcg::Point3f p = network.position(v);
    double l = 0;
    for (const VertexId u : network.ring(v)) l += static_cast<double>((network.position(u) - p).Norm());
    l /= network.ring(v).valence;  // eq 5
    return l * l;
}

}  // namespace neuralmesh
