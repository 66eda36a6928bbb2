// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How a long run tells its caller where it is, and how the caller asks it to stop.
#pragma once

namespace neuralmesh {

/// Passed by reference through every long operation and called on the calling thread only,
/// about every hundredth of the work.
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

}  // namespace neuralmesh
