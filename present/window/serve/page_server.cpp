// SPDX-License-Identifier: Apache-2.0
#include "present/window/serve/page_server.h"

#include <libwebsockets.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <list>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "host/base/error.h"
#include "host/base/source.h"
#include "present/window/serve/page_listen.h"
#include "present/window/serve/page_outgoing.h"
#include "present/window/serve/page_request.h"

namespace kilolux {
namespace {

constexpr std::size_t kMostTexts = 64;  // that wait for a page
constexpr int kMostStrangers = 8;       // connections that have not named the secret yet
constexpr lws_usec_t kLookMicroseconds = 1'000'000;  // how often a connection is looked at
constexpr std::chrono::milliseconds kGoodbye(200);
constexpr const char* kUsualEnd = "The session has ended.";
constexpr std::size_t kWriteBytes = std::size_t{1} << 20;  // at most, that one call writes

}  // namespace

class PageServer::Loop {
 public:
    Loop(const ServerOptions& options, const std::string& title, PageListener listener);
    ~Loop();

    const std::string& address() const { return address_; }
    int page_count() const { return page_count_; }
    bool is_waiting() const { return waiting_count_ > 0; }
    void show(const PageImage& image);
    void tell_driver(const std::string& json);
    void end(const std::string& reason);

 private:
    using Peers = std::list<PagePeer>;

    static int on_http(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t n);
    static int on_page(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t n);
    static Loop& of(lws* wsi) {
        return *static_cast<Loop*>(lws_context_user(lws_get_context(wsi)));
    }

    void listen(const ServerOptions& options);
    void run();
    bool may_connect(lws* wsi) const;

    Peers::iterator peer_of(lws* wsi);
    void come(lws* wsi);
    void leave(lws* wsi);
    int look_at(PagePeer& peer);
    int receive(PagePeer& peer, std::string_view part);
    void take(PagePeer& peer, PageMessage message);
    void admit(PagePeer& peer, const HelloMessage& hello);
    void tell(PagePeer& peer, std::string json);
    int send_next(PagePeer& peer);
    void dismiss(PagePeer& peer, const Farewell& farewell);
    PagePeer* driver();
    void obey_session();
    void count();

    std::string title_;
    PageListener listener_;
    std::string secret_ = make_secret();
    std::string page_;
    std::string address_;
    std::size_t viewers_;
    std::array<lws_protocols, 3> protocols_{};
    lws_context* context_ = nullptr;

    int connections_ = 0;  // of whatever kind, listening ones too; the server's thread only
    Peers peers_;          // in the order of their coming; the server's thread only
    std::shared_ptr<PageBytes> image_;  // that is sent; the server's thread only
    std::string ended_;                 // the reason; empty: it goes on; the server's thread only
    std::atomic<int> page_count_ = 0;
    std::atomic<int> waiting_count_ = 0;

    std::mutex mutex_;                   // of these:
    std::shared_ptr<PageBytes> newest_;  // from the session
    std::deque<std::string> driver_texts_;
    std::string end_reason_;  // empty: pages stay

    std::atomic<bool> stopping_ = false;
    std::thread thread_;
};

PageServer::Loop::Loop(const ServerOptions& options, const std::string& title,
                       PageListener listener)
    : title_(title),
      listener_(std::move(listener)),
      page_(embedded_text("present/window/serve/page.html")),
      viewers_(static_cast<std::size_t>(options.viewers)) {
    listen(options);
    ServeAddress seen = options.address;
    seen.port = lws_get_vhost_listen_port(lws_get_vhost_by_name(context_, "default"));
    address_ = (options.certificate.empty() ? "http://" : "https://") + host_in_url(seen) + ":" +
               std::to_string(seen.port) + "/#" + secret_;
    thread_ = std::thread([this] { run(); });
}

PageServer::Loop::~Loop() {
    end(kUsualEnd);
    const auto latest = std::chrono::steady_clock::now() + kGoodbye;
    while (page_count_ > 0 && std::chrono::steady_clock::now() < latest) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    stopping_ = true;
    lws_cancel_service(context_);
    thread_.join();
    lws_context_destroy(context_);
}

void PageServer::Loop::listen(const ServerOptions& options) {
    protocols_[0] = {"http", on_http, 0, 0, 0, nullptr, 0};
    protocols_[1] = {"kilolux", on_page, 0, kLongestPageMessage, 0, nullptr, kWriteBytes};
    context_ = listen_for_pages(options, protocols_.data(), this);
}

void PageServer::Loop::run() {
    // Signals are the session's; a write to a closed connection only fails.
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, nullptr);
    while (!stopping_ && lws_service(context_, 0) >= 0) {
    }
}

int PageServer::Loop::on_http(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                              std::size_t n) {
    switch (reason) {
        case LWS_CALLBACK_HTTP:
            return answer_request(wsi, static_cast<const char*>(in), of(wsi).page_);
        case LWS_CALLBACK_HTTP_WRITEABLE:
            return send_page(wsi, of(wsi).page_);
        case LWS_CALLBACK_EVENT_WAIT_CANCELLED:
            of(wsi).obey_session();
            return 0;
        case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
            return 1;  // a WebSocket that names no protocol
        case LWS_CALLBACK_FILTER_NETWORK_CONNECTION:
            return of(wsi).connections_ < kMostConnections ? 0 : 1;
        case LWS_CALLBACK_WSI_CREATE:
            ++of(wsi).connections_;
            return 0;
        case LWS_CALLBACK_WSI_DESTROY:
            --of(wsi).connections_;
            return 0;
        default:
            return lws_callback_http_dummy(wsi, reason, user, in, n);
    }
}

int PageServer::Loop::on_page(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                              std::size_t n) {
    Loop& loop = of(wsi);
    switch (reason) {
        case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
            return loop.may_connect(wsi) ? 0 : 1;
        case LWS_CALLBACK_ESTABLISHED:
            loop.come(wsi);
            return 0;
        case LWS_CALLBACK_CLOSED:
            loop.leave(wsi);
            return 0;
        case LWS_CALLBACK_EVENT_WAIT_CANCELLED:
            return 0;  // on_http() obeys
        case LWS_CALLBACK_TIMER:
        case LWS_CALLBACK_RECEIVE:
        case LWS_CALLBACK_SERVER_WRITEABLE:
            break;
        default:
            return lws_callback_http_dummy(wsi, reason, user, in, n);
    }
    const auto peer = loop.peer_of(wsi);
    if (peer == loop.peers_.end()) return -1;
    if (reason == LWS_CALLBACK_TIMER) return loop.look_at(*peer);
    if (reason == LWS_CALLBACK_SERVER_WRITEABLE) return loop.send_next(*peer);
    return loop.receive(*peer, {static_cast<const char*>(in), n});
}

bool PageServer::Loop::may_connect(lws* wsi) const {
    const auto strangers =
        std::ranges::count_if(peers_, [](const PagePeer& peer) { return !peer.admitted; });
    return comes_from_page(wsi) && strangers < kMostStrangers;
}

PageServer::Loop::Peers::iterator PageServer::Loop::peer_of(lws* wsi) {
    return std::ranges::find(peers_, wsi, &PagePeer::wsi);
}

void PageServer::Loop::come(lws* wsi) {
    peers_.emplace_back(wsi);
    lws_set_timer_usecs(wsi, kLookMicroseconds);
}

void PageServer::Loop::leave(lws* wsi) {
    const auto peer = peer_of(wsi);
    if (peer == peers_.end()) return;
    const bool drove = driver() == &*peer;
    peers_.erase(peer);
    count();
    if (!drove || !listener_.driver) return;
    PagePeer* next = driver();
    listener_.driver(next != nullptr);
    if (next != nullptr) tell(*next, R"({"role":"driver"})");
}

// Disconnects a page that does not say who it is, or does not take its picture.
int PageServer::Loop::look_at(PagePeer& peer) {
    const std::chrono::duration<double> age = PagePeer::Clock::now() - peer.came_at;
    if (!peer.admitted && age.count() > PagePeer::kHelloSeconds) return -1;
    if (peer.seconds_under_way() > kPatienceSeconds) return -1;
    lws_set_timer_usecs(peer.wsi, kLookMicroseconds);
    return 0;
}

int PageServer::Loop::receive(PagePeer& peer, std::string_view part) {
    if (peer.farewell.status != 0) return 0;
    const bool fits = peer.inbox.size() + part.size() <= kLongestPageMessage;
    if (!fits || lws_frame_is_binary(peer.wsi) != 0) {
        dismiss(peer, kNotUnderstood);
        return 0;
    }
    peer.inbox += part;
    if (lws_is_final_fragment(peer.wsi) == 0) return 0;
    const std::string text = std::exchange(peer.inbox, {});
    std::optional<PageMessage> message = parse_page_message(text);
    if (!message) {
        dismiss(peer, kNotUnderstood);
    } else if (peer.is_flooding()) {
        dismiss(peer, kTooMuch);
    } else {
        take(peer, std::move(*message));
    }
    return 0;
}

void PageServer::Loop::take(PagePeer& peer, PageMessage message) {
    if (const auto* hello = std::get_if<HelloMessage>(&message)) return admit(peer, *hello);
    if (!peer.admitted) return dismiss(peer, kWrongSecret);
    if (std::holds_alternative<AliveMessage>(message)) return tell(peer, R"({"alive":true})");
    if (const auto* shown = std::get_if<ShownMessage>(&message)) {
        if (!peer.under_way || shown->picture != peer.picture) return;
        peer.transport_ms = static_cast<float>(1e3 * peer.seconds_under_way());
        peer.under_way = false;
        count();
        lws_callback_on_writable(peer.wsi);
        listener_.ready();
        return;
    }
    if (driver() == &peer) listener_.message(std::move(message));
}

void PageServer::Loop::admit(PagePeer& peer, const HelloMessage& hello) {
    if (!same_secret(hello.secret, secret_)) return dismiss(peer, kWrongSecret);
    if (!ended_.empty()) return dismiss(peer, {kSessionOver, ended_});
    if (peer.admitted) return dismiss(peer, kNotUnderstood);
    // A page that was loaded again, or lost its connection, takes the place of its old self.
    const auto old = std::ranges::find_if(
        peers_, [&](const PagePeer& other) { return other.admitted && other.tab == hello.tab; });
    const auto self = peer_of(peer.wsi);
    if (old != peers_.end()) {
        peers_.splice(old, peers_, self);
        old->admitted = false;  // look_at() cuts it if it takes no goodbye
        dismiss(*old, kReplaced);
    } else if (static_cast<std::size_t>(page_count_) > viewers_) {
        return dismiss(peer, kNoRoom);
    }
    peer.admitted = true;
    peer.tab = hello.tab;
    count();
    const bool drives = driver() == &peer;
    tell(peer, page_text({{"role", drives ? "driver" : "watcher"}, {"title", title_}}));
    if (drives) {
        listener_.message(SizeMessage{hello.size});
        listener_.driver(true);
    }
    listener_.ready();
}

void PageServer::Loop::tell(PagePeer& peer, std::string json) {
    // A page that takes no messages keeps the newest.
    if (peer.texts.size() >= kMostTexts) peer.texts.pop_front();
    peer.texts.push_back(std::move(json));
    lws_callback_on_writable(peer.wsi);
}

int PageServer::Loop::send_next(PagePeer& peer) {
    if (peer.farewell.status != 0) return send_farewell(peer.wsi, peer.farewell);
    if (!peer.texts.empty()) {
        const std::string text = std::move(peer.texts.front());
        peer.texts.pop_front();
        lws_callback_on_writable(peer.wsi);
        return send_text(peer.wsi, text);
    }
    const bool waits = peer.admitted && !peer.under_way;
    if (!waits || !image_ || image_->number == peer.picture) return 0;
    peer.picture = image_->number;
    peer.under_way = true;
    peer.sent_at = PagePeer::Clock::now();
    count();
    return send_image(peer.wsi, *image_, peer.transport_ms);
}

void PageServer::Loop::dismiss(PagePeer& peer, const Farewell& farewell) {
    peer.farewell = farewell;
    lws_callback_on_writable(peer.wsi);
}

PagePeer* PageServer::Loop::driver() {
    const auto found = std::ranges::find_if(peers_, &PagePeer::admitted);
    return found == peers_.end() ? nullptr : &*found;
}

void PageServer::Loop::count() {
    page_count_ = static_cast<int>(std::ranges::count_if(peers_, &PagePeer::admitted));
    waiting_count_ = static_cast<int>(std::ranges::count_if(
        peers_, [](const PagePeer& peer) { return peer.admitted && !peer.under_way; }));
}

void PageServer::Loop::show(const PageImage& image) {
    std::shared_ptr<PageBytes> next = page_bytes(image);
    {
        const std::lock_guard lock(mutex_);
        newest_ = std::move(next);
    }
    lws_cancel_service(context_);
}

void PageServer::Loop::tell_driver(const std::string& json) {
    {
        const std::lock_guard lock(mutex_);
        if (driver_texts_.size() >= kMostTexts) driver_texts_.pop_front();
        driver_texts_.push_back(json);
    }
    lws_cancel_service(context_);
}

void PageServer::Loop::end(const std::string& reason) {
    {
        const std::lock_guard lock(mutex_);
        if (end_reason_.empty()) end_reason_ = close_reason(reason);
    }
    lws_cancel_service(context_);
}

// In the server's thread: takes what the session has for the pages.
void PageServer::Loop::obey_session() {
    std::deque<std::string> texts;
    {
        const std::lock_guard lock(mutex_);
        if (newest_) image_ = std::move(newest_);
        texts.swap(driver_texts_);
        ended_ = end_reason_;
    }
    if (PagePeer* page = driver()) {
        for (std::string& text : texts) tell(*page, std::move(text));
    }
    for (PagePeer& peer : peers_) {
        if (!ended_.empty()) dismiss(peer, {kSessionOver, ended_});
        lws_callback_on_writable(peer.wsi);
    }
}

PageServer::PageServer(const ServerOptions& options, const std::string& title,
                       PageListener listener)
    : loop_(std::make_unique<Loop>(options, title, std::move(listener))) {}
PageServer::~PageServer() = default;
const std::string& PageServer::address() const { return loop_->address(); }
int PageServer::page_count() const { return loop_->page_count(); }
bool PageServer::is_waiting() const { return loop_->is_waiting(); }
void PageServer::show(const PageImage& image) { loop_->show(image); }
void PageServer::tell_driver(const std::string& json) { loop_->tell_driver(json); }
void PageServer::end(const std::string& reason) { loop_->end(reason.empty() ? kUsualEnd : reason); }

}  // namespace kilolux
