// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kilolux {

enum class Verbosity { quiet, normal, verbose };

/// Sets what note() and detail() print; warnings and errors are always printed.
void set_verbosity(Verbosity verbosity);

/// "kilolux: warning: <message>" on stderr, each distinct message once per process.
void warn(std::string_view message);

/// One line on stderr unless --quiet.
void note(std::string_view message);

/// A note that the user waits. The library prints it only to a terminal; after show_waits() to
/// logs, too.
void note_wait(std::string_view message);
void show_waits();

/// One line on stderr with --verbose.
void detail(std::string_view message);

}  // namespace kilolux
