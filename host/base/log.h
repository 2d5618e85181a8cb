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

/// The same about something that takes time. In a log it tells a reader why; a library writes none
/// there, and show_waits() makes the program do so.
void note_wait(std::string_view message);
void show_waits();

/// One line on stderr with --verbose.
void detail(std::string_view message);

}  // namespace kilolux
