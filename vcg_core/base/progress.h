// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How a long run tells its caller where it is, and how the caller asks it to stop.
#pragma once

#include <algorithm>

namespace neuralmesh {

/// Passed by reference through every long operation and called on the calling thread only: every thousand
/// signals of the learning or somewhat more, every round of the fit, every stage of the start mesh.
class Progress {
public:
    virtual ~Progress() = default;

    /// \param fraction of the whole run done so far, in [0, 1], never decreasing
    /// \param text     what is being done, with its numbers
    /// \return false to ask for an early, orderly end with the valid mesh so far
    virtual bool operator()(double fraction, const char* text) = 0;
};

/// Reports to nobody and never asks to stop.
class NoProgress : public Progress {
public:
    bool operator()(double /*fraction*/, const char* /*text*/) override { return true; }
};

/// A part of a longer run, from one fraction of the whole to another.
class PartOf : public Progress {
public:
    PartOf(Progress& whole, double from, double to) : whole_(whole), from_(from), to_(to) {}
    bool operator()(double fraction, const char* text) override {
        return whole_(std::min(from_ + fraction * (to_ - from_), to_), text);
    }

private:
    Progress& whole_;
    double from_;
    double to_;
};

/// For a run whose parts may repeat: fractions never decrease, and a request to stop is remembered.
class MonotoneProgress : public Progress {
public:
    explicit MonotoneProgress(Progress& caller) : caller_(caller) {}
    bool operator()(double fraction, const char* text) override {
        done_ = std::max(done_, fraction);
        stopped_ = stopped_ || !caller_(done_, text);
        return !stopped_;
    }
    bool stopped() const { return stopped_; }

private:
    Progress& caller_;
    double done_ = 0;
    bool stopped_ = false;
};

}  // namespace neuralmesh
