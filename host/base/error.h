// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace kilolux {

/// A runtime error (file, device, driver), as one line: what, where, the value seen, e.g.
/// "scene.gltf: light 12: range is -1, must be > 0". A programmer's mistake is an assert instead.
class Error : public std::runtime_error {
 public:
    using std::runtime_error::runtime_error;
};

/// A command line that cannot be obeyed: main() turns it into exit code 2.
class UsageError : public Error {
 public:
    using Error::Error;
};

/// A comparison that was asked for and failed: exit code 3.
class ComparisonFailed : public Error {
 public:
    using Error::Error;
};

/// SIGINT or SIGTERM: exit code 130.
class Interrupted : public Error {
 public:
    Interrupted() : Error("interrupted") {}
};

}  // namespace kilolux
