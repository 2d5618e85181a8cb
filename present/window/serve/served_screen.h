// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <variant>

#include "host/picture/frame.h"
#include "present/window/screen/screen.h"
#include "present/window/serve/page_server.h"
#include "raster/gl_context.h"
#include "raster/gl_object.h"

namespace kilolux {

/// A page in a browser: what is drawn goes to it as JPEG while it changes and as PNG at rest, and
/// its input comes back as events. Without a page it counts as minimised.
class ServedScreen : public Screen {
 public:
    /// A picture is sent without loss when it has stood so long and no other is being made [s].
    static constexpr double kRestSeconds = 0.25;

    /// Throws Error where there is no headless OpenGL 4.5, or the server cannot listen.
    ServedScreen(const ServerOptions& options, const std::string& title);
    ~ServedScreen() override;

    /// Sets the size until a page has said its own.
    void begin(std::array<int, 2> size);

    /// The address to open, with the secret.
    const std::string& address() const { return server_->address(); }

    void use_worker_context(bool use) const override;
    void wait_events(double seconds) override;
    void wake() override;
    bool should_close() const override { return closed_; }
    void close() override { closed_ = true; }
    void hide() override { server_->end(); }
    /// hide(), and pages show why.
    void end(const std::string& reason) { server_->end(reason); }
    std::array<int, 2> size() const override { return size_; }
    std::array<int, 2> framebuffer() const override { return size_; }
    unsigned framebuffer_name() override;
    void swap() override;
    void set_changing(bool changing) override { changing_ = changing; }
    bool is_behind() const override { return fresh_ && !is_minimised(); }
    float content_scale() const override { return scale_; }
    bool is_minimised() const override { return server_->page_count() == 0; }
    /// The page's next size replaces it.
    void resize(std::array<int, 2> size) override;
    void set_vsync(bool) override {}
    void set_full_screen(bool on) override;
    bool is_full_screen() const override { return full_screen_; }
    std::array<int, 2> size_to_keep() const override { return size_to_keep_; }
    void grab_mouse(bool) override {}
    void set_cursor(Cursor cursor) override;
    void set_clipboard(const std::string& text) override;
    std::string clipboard() const override { return clipboard_; }

 private:
    using Clock = std::chrono::steady_clock;
    struct DriverChange {
        bool here = false;
    };
    using Note = std::variant<PageMessage, DriverChange>;
    /// More are not kept: the session is not listening.
    static constexpr std::size_t kMostNotes = 4096;

    void note(Note note);
    void take(const PageMessage& message);
    void take(DriverChange change);
    bool send_picture();
    bool is_rest_due() const;
    void code(bool lossless);
    void show(const Frame& frame, PageImage image);

    GlContext worker_ = GlContext::headless();
    GlContext session_ = GlContext::headless();  // current
    GlTexture colour_;
    GlFramebuffer framebuffer_;
    std::array<int, 2> allocated_{};  // of colour_ [pixel]

    std::array<int, 2> size_{1280, 720};
    std::array<int, 2> size_to_keep_{1280, 720};
    float scale_ = 1.0f;
    std::atomic<bool> closed_ = false;  // by any thread
    bool full_screen_ = false;
    Cursor cursor_ = Cursor::arrow;
    std::string clipboard_;

    bool changing_ = false;  // see set_changing()
    bool drawn_ = false;     // at this size
    bool fresh_ = false;     // drawn and not sent
    bool lossless_ = false;  // what was drawn last was sent as PNG
    Clock::time_point drawn_at_;
    double made_ms_ = 0.0;  // Unix time of drawn_at_
    std::uint32_t number_ = 0;
    std::atomic<bool> is_coding_ = false;

    std::mutex mutex_;  // of these:
    std::condition_variable changed_;
    std::deque<Note> notes_;
    bool lost_notes_ = false;
    bool woken_ = false;
    bool ready_ = false;  // a page takes a picture, or one is coded

    std::unique_ptr<PageServer> server_;
    std::future<void> coding_;  // last: it uses the server
};

}  // namespace kilolux
