// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How many vertices a mesh needs for the error that is asked for.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace neuralmesh {

/// Proposes numbers of vertices to try, from the errors of those tried before. The error falls with a power
/// of the number: the first on smooth surfaces, a lower one with creases, none at the noise that is left.
class ErrorSearch {
public:
    struct Trial {
        int vertices;
        double error;  ///< at least 0, in the unit of the error asked for
    };
    /// \pre wanted > 0, 0 < least <= most
    ErrorSearch(double wanted, int least, int most) : wanted_(wanted), least_(least), most_(most) {}

    /// The number to try next; 0: enough were tried.
    int next() const;
    /// \pre \p vertices was not tried before
    void add(int vertices, double error);
    /// \p vertices were too few for a mesh: none below one and a half times as many is tried again.
    /// \pre there may be more
    void too_few(int vertices) { least_ = std::min(vertices + vertices / 2 + 1, most_); }

    /// Whether one of those tried has the error asked for.
    bool reached() const { return enough() != trials_.size(); }
    /// Whether more vertices hardly lowered the error any more.
    bool levels_off() const;
    /// The fewest vertices with the error asked for or, if there are none, with hardly more than the least.
    /// \pre add() has been called
    Trial best() const;

private:
    int extrapolated(const Trial& from, double exponent, int low, int high) const;
    /// Of the error as it falls from \p a to \p b.
    static double exponent(const Trial& a, const Trial& b);
    bool is_enough(const Trial& trial) const;
    /// Index of the first trial that is enough; their number: none.
    std::size_t enough() const;

    double wanted_;
    int least_, most_;
    std::vector<Trial> trials_;  ///< in ascending order of vertices
};

}  // namespace neuralmesh
