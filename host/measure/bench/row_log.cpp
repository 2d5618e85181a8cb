// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/row_log.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "host/base/error.h"

namespace kilolux {
namespace {

std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw Error(file.string() + ": cannot read: " + std::strerror(errno));
    return {std::istreambuf_iterator<char>(in), {}};
}

// A file descriptor that closes itself.
class Descriptor {
 public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return number_; }

 private:
    int number_;
};

void require(bool done, const std::filesystem::path& file) {
    if (!done) throw Error(file.string() + ": cannot write: " + std::strerror(errno));
}

void write_all(int descriptor, std::string_view text, const std::filesystem::path& file) {
    while (!text.empty()) {
        const ssize_t written = ::write(descriptor, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        require(written >= 0, file);
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

// Without its header line.
std::string lines_of(const std::vector<BenchRow>& rows) {
    const std::string csv = to_csv(bench_table(rows));
    return csv.substr(csv.find('\n') + 1);
}

}  // namespace

BenchLog::BenchLog(std::filesystem::path file, bool resume) : file_(std::move(file)) {
    if (!resume || !std::filesystem::exists(file_)) return;
    std::string text = text_of(file_);
    text.erase(text.rfind('\n') + 1);  // npos + 1 is 0: no line is whole
    try {
        found_ = parse_bench_csv(text);
    } catch (const Error& error) {
        throw Error(file_.string() + ": " + error.what());
    }
    std::size_t dropped = 0;
    while (!found_.empty() && found_.back().stage != kFrameStage) {
        found_.pop_back();
        ++dropped;
    }
    for (; dropped > 0; --dropped) text.erase(text.rfind('\n', text.size() - 2) + 1);
    kept_bytes_ = text.size();
}

std::vector<BenchRow> BenchLog::rows_of(const SweepPoint& point, const std::string& context) const {
    std::vector<BenchRow> rows;
    for (const BenchRow& row : found_) {
        if (row.point == point && row.context == context) rows.push_back(row);
    }
    return rows;
}

void BenchLog::append(const std::vector<BenchRow>& rows) {
    const Descriptor out(::open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
    require(out.get() >= 0, file_);
    std::string text = lines_of(rows);
    if (!started_) {
        require(::ftruncate(out.get(), static_cast<off_t>(kept_bytes_)) == 0, file_);
        if (kept_bytes_ == 0) text = to_csv(bench_table(rows));
        started_ = true;
    }
    write_all(out.get(), text, file_);
    require(::fsync(out.get()) == 0, file_);
}

}  // namespace kilolux
