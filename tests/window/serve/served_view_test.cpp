// SPDX-License-Identifier: Apache-2.0
// `kilolux view --serve` without a display, as its page sees it.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <chrono>
#include <nlohmann/json.hpp>

#include "tests/window/expected_picture.h"
#include "tests/window/scripted_window.h"
#include "tests/window/serve/served_view.h"

namespace kilolux {
namespace {

// A page that shows each picture at once.
class ShowingPage {
 public:
    ShowingPage(const ServedView& view, int width, int height) : client_(view.address()) {
        client_.hello(view.address().secret, "tab", width, height);
    }
    PageClient& client() { return client_; }
    void send(const std::string& json) { client_.send(json); }
    void key(const std::string& code, int modifiers = 0) {
        for (const int action : {1, 0}) {
            send(fmt::format(R"(["key","{}",{},{}])", code, action, modifiers));
        }
    }

    // The next picture of the size; texts before it are kept.
    ReceivedPicture picture() {
        for (;;) {
            const auto frame = client_.next(kLong);
            if (!frame) throw std::runtime_error("no picture");
            if (frame->opcode == 1) texts_.push_back(frame->payload);
            if (frame->opcode != 2) continue;
            const ReceivedPicture out = received_picture(frame);
            send(fmt::format(R"(["shown",{}])", out.number));
            return out;
        }
    }
    // The picture without loss that is followed by no other for a while.
    ServedPixels rest() {
        const auto latest = std::chrono::steady_clock::now() + std::chrono::minutes(5);
        bool lossless = false;
        while (std::chrono::steady_clock::now() < latest) {
            const auto received = receive(lossless ? 2.0 : kLong);
            if (!received && lossless) return last_;
            if (!received) break;
            lossless = *received;
        }
        throw std::runtime_error("no picture at rest");
    }
    // The next picture without loss.
    ServedPixels lossless() {
        for (;;) {
            const auto received = receive(kLong);
            if (!received) throw std::runtime_error("no picture without loss");
            if (*received) return last_;
        }
    }
    // Whether the picture at rest is that one, or becomes it: one that rests before shows a
    // message, or what was there before input that comes late.
    bool comes_to(const ServedPixels& expected) {
        while (last_ != expected) {
            if (!receive(kLong)) return false;
        }
        return true;
    }
    // The value of the last text with that name.
    std::string told(const std::string& name) const {
        std::string out;
        for (const std::string& text : texts_) {
            const auto json = nlohmann::json::parse(text);
            if (json.contains(name)) out = json[name].get<std::string>();
        }
        return out;
    }

 private:
    // Takes the next picture, keeps it if it is without loss, and texts before it; returns whether
    // it was. None: nothing came.
    std::optional<bool> receive(double seconds) {
        for (;;) {
            const auto frame = client_.next(seconds);
            if (!frame) return std::nullopt;
            if (frame->opcode == 1) texts_.push_back(frame->payload);
            if (frame->opcode != 2) continue;
            const ReceivedPicture picture = received_picture(frame);
            send(fmt::format(R"(["shown",{}])", picture.number));
            const auto* bytes = reinterpret_cast<const unsigned char*>(picture.file.data());
            if (picture.lossless)
                last_ = pixels_of(open_encoded("png", {bytes, picture.file.size()}));
            return picture.lossless;
        }
    }

    PageClient client_;
    std::vector<std::string> texts_;
    ServedPixels last_;  // without loss
};

TEST(ServedView, ThePictureAtRestIsThatOfRenderInEveryByte) {
    const ServedPixels first = rendered_by("kilolux render plain --lights 150", 640, 400);
    ServedView view;
    ShowingPage page(view, 640, 400);
    EXPECT_EQ(page.lossless(), first);  // not the empty screen before, which stays for seconds
    EXPECT_EQ(page.told("title"), "Kilolux - plain");
    // A drag moves the camera; while it does, pictures are JPEG.
    page.send(R"(["move",300,200])");
    page.send(R"(["button",0,1,0])");
    EXPECT_FALSE(page.picture().lossless);
    page.send(R"(["move",420,230])");
    page.send(R"(["button",0,0,0])");
    page.send(R"(["move",-1,-1])");
    page.rest();
    page.key("KeyC");
    page.rest();
    const std::string command = page.told("clipboard");
    ASSERT_TRUE(command.starts_with("kilolux render")) << command;
    const ServedPixels moved = rendered_by(command, 640, 400);
    EXPECT_TRUE(page.comes_to(moved)) << command;
    EXPECT_NE(moved, first);
    const ServedPixels small = rendered_by(command, 320, 240);
    page.send(R"(["size",320,240,1])");
    EXPECT_TRUE(page.comes_to(small));
}

TEST(ServedView, SurvivesItsPageAndEndsWhenAsked) {
    ServedView view;
    {
        ShowingPage page(view, 640, 400);
        page.send(R"(["key","KeyW",1,0])");  // is released by nobody
        page.picture();
    }
    ShowingPage again(view, 640, 400);
    again.rest();  // a key that is down would move the camera without end
    again.key("KeyQ", 2);
    EXPECT_EQ(again.client().farewell(kLong), 4000);
    const ChildResult result = view.program().result();
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(result.out.find('\n'), result.out.size() - 1);  // the address alone
}

TEST(ServedView, ASignalSaysGoodbye) {
    ServedView view;
    ShowingPage page(view, 320, 240);
    page.picture();
    view.program().signal(SIGINT);
    EXPECT_EQ(page.client().farewell(kLong), 4000);
    EXPECT_EQ(view.program().result().code, 130);
}

// One code for window and page: a script sees the same in both.
TEST(ServedView, ScriptsDriveIt) {
    const TemporaryFolder folder;
    Script script(folder);
    script.line("slide exposure -2").line("away").shot("dark");
    script.line("resize 620 380").line("open window").line("click overlay").shot("small");
    std::vector<std::string> words = small_window(script.write());
    words.insert(words.begin(), program_file());
    words.emplace_back("--serve");
    const ChildResult result = run_child(with_variables(kNoDisplay, words));
    ASSERT_EQ(result.code, 0) << result.err;
    ExpectedPicture expected;
    expect_same_picture(folder / "dark.png",
                        expected.of([](RenderSettings& s) { s.exposure = -2.0f; }));
    EXPECT_EQ(scene_part(folder / "small.png").width, 620);
}

TEST(ServedView, WrongOptionsAreALine) {
    const auto message = [](const std::vector<std::string>& more) {
        std::vector<std::string> words = {"view", "plain", "--fresh"};
        words.insert(words.end(), more.begin(), more.end());
        const ChildResult result = run_kilolux(words);
        EXPECT_NE(result.code, 0);
        EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
        return result.err;
    };
    EXPECT_NE(message({"--serve", "atrium"}).find("'atrium' is not ADDRESS:PORT"),
              std::string::npos);
    EXPECT_NE(message({"--viewers", "2"}).find("--viewers: needs --serve"), std::string::npos);
    EXPECT_NE(message({"--serve", "--tls-key", "key.pem"}).find("belong together"),
              std::string::npos);
    EXPECT_NE(message({"--serve", "--tls-key", "no.pem", "--tls-certificate", "no.pem"})
                  .find("no.pem: No such file"),
              std::string::npos);
    EXPECT_NE(message({"--serve", "192.0.2.1:80"}).find("cannot listen at 192.0.2.1:80"),
              std::string::npos);
}

}  // namespace
}  // namespace kilolux
