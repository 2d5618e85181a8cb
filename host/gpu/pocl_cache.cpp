// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/pocl_cache.h"

#include <sys/mman.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "host/base/log.h"
#include "host/base/system/temporary_folder.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLeastFree = std::uint64_t{32} << 20;  // [byte]

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
}

// PoCL's cache folder, by the rules of its pocl_cache.c.
fs::path pocl_folder() {
    if (const std::string own = environment("POCL_CACHE_DIR"); !own.empty()) return own;
    if (const std::string cache = environment("XDG_CACHE_HOME"); !cache.empty()) {
        return fs::path(cache) / "pocl/kcache";
    }
    const std::string home = environment("HOME");
    return home.empty() ? fs::path("/tmp/pocl/kcache") : fs::path(home) / ".cache/pocl/kcache";
}

// Code that may be written but not run is refused by mmap().
bool may_run(int file) {
    void* page = ::mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE, file, 0);
    if (page == MAP_FAILED) return false;
    ::munmap(page, 4096);
    return true;
}

bool has_linker(const std::string& path) {
    std::istringstream folders(path);
    for (std::string folder; std::getline(folders, folder, ':');) {
        if (::access((fs::path(folder) / "ld").c_str(), X_OK) == 0) return true;
    }
    return false;
}

// Returns why there is none; empty: there is one, removed when the program exits.
std::string use_private_folder() try {
    static const TemporaryFolder folder;
    const std::string name = folder.path().string();
    if (const std::string problem = cache_problem(name); !problem.empty()) {
        return name + ": " + problem;
    }
    ::setenv("POCL_CACHE_DIR", name.c_str(), 1);
    return "";
} catch (const std::exception&) {
    return "no temporary folder can be made";
}

std::string prepared() {
    const std::string path = environment("PATH");
    if (!has_linker(path)) {
        if (!has_linker("/usr/bin")) {
            return "PoCL (OpenCL on the CPU) needs the linker ld on PATH: install binutils";
        }
        ::setenv("PATH", (path.empty() ? "/usr/bin" : path + ":/usr/bin").c_str(), 1);
    }
    // PoCL ends with an assertion where the variable is there but empty.
    if (environment("POCL_CACHE_DIR").empty()) ::unsetenv("POCL_CACHE_DIR");
    const fs::path folder = pocl_folder();
    const std::string problem = cache_problem(folder);
    if (problem.empty()) return "";
    const std::string why = "PoCL's folder of kernels " + folder.string() + ": " + problem;
    const std::string other = use_private_folder();
    if (!other.empty())
        return why + "; " + other + "; set POCL_CACHE_DIR to a folder that can be used";
    warn(why + "; this run keeps them in a temporary folder");
    return "";
}

}  // namespace

std::string cache_problem(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) return "cannot be made: " + error.message();
    std::string name = (folder / "kilolux-XXXXXX").string();
    const int file = ::mkstemp(name.data());
    if (file < 0) return std::string("cannot be written to: ") + std::strerror(errno);
    ::unlink(name.c_str());
    struct statvfs space = {};
    std::string problem;
    if (::ftruncate(file, 4096) != 0 || !may_run(file)) {
        problem = "code in it may not run";
    } else if (::fstatvfs(file, &space) == 0 && space.f_bavail * space.f_frsize < kLeastFree) {
        problem = "less than 32 MiB are free";
    }
    ::close(file);
    return problem;
}

const std::string& prepare_pocl() {
    static const std::string missing = prepared();
    return missing;
}

}  // namespace kilolux
