// An X server of the test's own (Xvfb), and hands in it: real input events (XTest), drag and drop (XDND), and eyes.
#pragma once

#include "engine/capture/png_file.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace splice::test {

class VirtualDisplay {
  public:
    /// Nothing where Xvfb is not installed: then prints what is skipped.
    static std::unique_ptr<VirtualDisplay> start(std::uint32_t width = 1400, std::uint32_t height = 900);
    ~VirtualDisplay();
    VirtualDisplay(const VirtualDisplay&) = delete;
    VirtualDisplay& operator=(const VirtualDisplay&) = delete;

    const std::string& name() const { return name_; }  // ":99"

    /// The window whose title ends in "splice-view"; false if there is none in time.
    bool find_window(double seconds = 30);
    std::string title() const;
    bool wait_for_title(const std::string& title, double seconds = 60) const;
    /// Of the window, without borders, as shown.
    Picture picture() const;
    /// True once the window has taken note of all input so far and has gone through its loop since; false if it does
    /// not say so in time.
    bool caught_up(double seconds = 90) const;
    /// The picture once `wanted` likes it and it stands still, or the last one after so many seconds. A window that is
    /// busy does not stand still.
    Picture picture_when(const std::function<bool(const Picture&)>& wanted, double seconds = 90) const;
    /// Once it stands still.
    Picture still_picture() const;

    // In window coordinates.
    void move(int x, int y);
    void press(unsigned button);
    void release(unsigned button);
    void click(int x, int y, unsigned button = 1);
    void drag(int from_x, int from_y, int to_x, int to_y, unsigned button = 1);
    void wheel(int notches);                         // positive: away from the hand
    void key(const char* name, bool shift = false);  // as XStringToKeysym knows it
    void resize(unsigned width, unsigned height, double seconds_after = 0.05);
    /// What a window manager says of a window that it hides, or shows again.
    void say_minimised(bool minimised);
    /// What is on the clipboard, as another program gets it; nothing if nobody gives it in time.
    std::optional<std::string> clipboard(double seconds = 30) const;
    /// True if the window took the files.
    bool drop(const std::filesystem::path& file, int x, int y);
    /// What desktops say of the monitor's scale (96 times it), to programs that start later.
    void set_dots_per_inch(int dots);
    void ask_to_close();
    /// What no program should do to another's window.
    void destroy_window();

  private:
    struct Connection;
    VirtualDisplay() = default;
    void settle(double seconds = 0.05) const;
    bool answers_ping(double seconds) const;

    int server_ = -1;  // process
    std::string name_;
    std::unique_ptr<Connection> connection_;
};

/// Share of the pixels in which two pictures of one size differ by more than `tolerance` in a channel.
double difference(const Picture& a, const Picture& b, int tolerance = 0);

/// Part of a picture.
Picture cropped(const Picture& picture, std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height);

}  // namespace splice::test
