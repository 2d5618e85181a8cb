// SPDX-License-Identifier: Apache-2.0
#include "present/window/serve/served_screen.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "host/base/log.h"
#include "present/image/image_file.h"
#include "present/window/screen/read_screen.h"
#include "present/window/serve/page_outgoing.h"

namespace kilolux {
namespace {

// 258 KB and 7 ms of a core at 1280x720 for the atrium; quality 95 has 480 KB.
constexpr int kMovingQuality = 85;

double unix_ms() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(now).count();
}

// CSS names by Cursor.
constexpr const char* kCssCursors[] = {"default", "text", "ns-resize", "ew-resize", "pointer"};

}  // namespace

ServedScreen::ServedScreen(const ServerOptions& options, const std::string& title) {
    load_image_library();
    PageListener listener;
    listener.message = [this](PageMessage message) { note(std::move(message)); };
    listener.driver = [this](bool here) { note(DriverChange{here}); };
    listener.ready = [this] {
        {
            const std::lock_guard lock(mutex_);
            ready_ = true;
        }
        changed_.notify_one();
    };
    server_ = std::make_unique<PageServer>(options, title, std::move(listener));
    if (is_loopback(options.address)) return;
    warn(std::string("served window: other machines can connect") +
         (options.certificate.empty()
              ? ", and nothing is encrypted; kilolux view has --tls-certificate and --tls-key"
              : ""));
}

ServedScreen::~ServedScreen() {
    if (coding_.valid()) coding_.wait();
    server_.reset();  // its thread calls this
}

void ServedScreen::begin(std::array<int, 2> size) { size_ = size_to_keep_ = size; }

void ServedScreen::use_worker_context(bool use) const {
    use ? worker_.make_current() : GlContext::make_none_current();
}

// Called in the server's thread.
void ServedScreen::note(Note note) {
    {
        const std::lock_guard lock(mutex_);
        if (notes_.size() < kMostNotes) {
            notes_.push_back(std::move(note));
        } else {
            lost_notes_ = true;
        }
    }
    changed_.notify_one();
}

void ServedScreen::wake() {
    {
        const std::lock_guard lock(mutex_);
        woken_ = true;
    }
    changed_.notify_one();
}

void ServedScreen::wait_events(double seconds) {
    auto end = Clock::now() +
               std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    bool done = false;
    while (!done) {
        if (send_picture()) end = Clock::now();  // for the next one
        std::unique_lock lock(mutex_);
        const auto rest =
            drawn_at_ + std::chrono::milliseconds(static_cast<int>(1e3 * kRestSeconds) + 1);
        const bool rests_later = drawn_ && !lossless_ && !changing_ && rest > Clock::now();
        changed_.wait_until(lock, rests_later ? std::min(end, rest) : end,
                            [this] { return woken_ || ready_ || !notes_.empty(); });
        const std::deque<Note> notes = std::exchange(notes_, {});
        done = std::exchange(woken_, false) || !notes.empty() || Clock::now() >= end;
        ready_ = false;
        const bool lost = std::exchange(lost_notes_, false);
        lock.unlock();
        for (const Note& each : notes) {
            std::visit([this](const auto& what) { take(what); }, each);
        }
        // A lost release would leave a key down.
        if (lost) post(FocusEvent{false});
    }
}

void ServedScreen::take(const PageMessage& message) {
    if (const auto* input = std::get_if<InputMessage>(&message)) {
        for (const InputEvent& event : *input) post(event);
    } else if (const auto* size = std::get_if<SizeMessage>(&message)) {
        scale_ = size->size.scale;
        resize({size->size.width, size->size.height});
    } else if (const auto* full = std::get_if<FullScreenMessage>(&message)) {
        full_screen_ = full->on;
    }
}

void ServedScreen::take(DriverChange change) {
    cursor_ = Cursor::arrow;  // a page's first
    post(FocusEvent{change.here});
    post(RedrawEvent{});
}

void ServedScreen::resize(std::array<int, 2> size) {
    if (size != size_) drawn_ = fresh_ = false;
    size_ = size;
    post(RedrawEvent{});
}

unsigned ServedScreen::framebuffer_name() {
    if (allocated_ != size_) {
        colour_ = make_texture(GL_TEXTURE_2D);
        glTextureStorage2D(colour_.name(), 1, GL_RGBA8, size_[0], size_[1]);
        framebuffer_ = make_framebuffer();
        glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, colour_.name(), 0);
        check_gl_errors("served screen");
        allocated_ = size_;
    }
    return framebuffer_.name();
}

void ServedScreen::swap() {
    drawn_ = fresh_ = true;
    lossless_ = false;
    drawn_at_ = Clock::now();
    made_ms_ = unix_ms();
}

bool ServedScreen::is_rest_due() const {
    const std::chrono::duration<double> rest = Clock::now() - drawn_at_;
    return !lossless_ && !changing_ && rest.count() >= kRestSeconds;
}

// Has what was drawn last coded, once a page takes it and the picture before is coded. Returns
// whether the screen was behind and is no longer.
bool ServedScreen::send_picture() {
    if (is_coding_ || !drawn_ || !server_->is_waiting()) return false;
    if (coding_.valid()) coding_.get();  // throws the coder's error
    const bool was_fresh = fresh_;
    const bool rests = is_rest_due();
    if (fresh_ || rests) code(rests);
    return was_fresh;
}

// Called in the coder's thread.
void ServedScreen::show(const Frame& frame, PageImage image) {
    ImageOptions options;
    options.jpeg_quality = kMovingQuality;
    const std::vector<unsigned char> file =
        encode_image(image.lossless ? "picture.png" : "picture.jpg", frame, {}, options);
    image.file = file;
    server_->show(image);
}

void ServedScreen::code(bool lossless) {
    fresh_ = false;
    lossless_ = lossless;
    is_coding_ = true;
    const PageImage image{++number_, lossless, made_ms_, {}};
    coding_ = std::async(std::launch::async, [this, image, frame = read_screen(*this)] {
        std::exception_ptr failure;
        try {
            show(frame, image);
        } catch (...) {
            failure = std::current_exception();
        }
        {
            const std::lock_guard lock(mutex_);
            is_coding_ = false;
            ready_ = true;
        }
        changed_.notify_one();
        if (failure) std::rethrow_exception(failure);
    });
}

void ServedScreen::set_full_screen(bool on) {
    server_->tell_driver(page_text({{"full-screen", on}}));
}

void ServedScreen::set_cursor(Cursor cursor) {
    if (cursor == cursor_) return;
    cursor_ = cursor;
    server_->tell_driver(page_text({{"cursor", kCssCursors[static_cast<std::size_t>(cursor)]}}));
}

void ServedScreen::set_clipboard(const std::string& text) {
    clipboard_ = text;
    server_->tell_driver(page_text({{"clipboard", text}}));
}

}  // namespace kilolux
