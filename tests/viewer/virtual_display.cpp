#include "tests/viewer/virtual_display.h"

#include "tests/viewer/drag_and_drop.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>
#include <X11/keysym.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <thread>

namespace splice::test {

namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void sleep_seconds(double seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

// Xvfb writes the number that it chose to the descriptor once it listens.
std::string read_display_number(int descriptor) {
    std::string number;
    for (;;) {
        pollfd waiting{descriptor, POLLIN, 0};
        if (poll(&waiting, 1, 30000) <= 0) return "";
        char c = 0;
        if (read(descriptor, &c, 1) != 1) return "";
        if (c == '\n') return number;
        number += c;
    }
}

int ignore_error(Display*, XErrorEvent*) {
    return 0;  // a window may go while it is asked
}

std::string title_of(Display* display, Window window) {
    char* text = nullptr;
    if (XFetchName(display, window, &text) == 0 || text == nullptr) return "";
    std::string title(text);
    XFree(text);
    return title;
}

Window find_titled(Display* display, Window parent, const std::string& end) {
    Window root = 0, above = 0;
    Window* children = nullptr;
    unsigned count = 0;
    Window found = 0;
    if (XQueryTree(display, parent, &root, &above, &children, &count) == 0) return 0;
    for (unsigned i = 0; i < count && found == 0; ++i)
        found = title_of(display, children[i]).ends_with(end) ? children[i] : find_titled(display, children[i], end);
    if (children != nullptr) XFree(children);
    return found;
}

XEvent client_message(Display* display, Window window, const char* type) {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = window;
    event.xclient.message_type = XInternAtom(display, type, False);
    event.xclient.format = 32;
    return event;
}

}  // namespace

struct VirtualDisplay::Connection {
    Display* display = nullptr;
    Window window = 0;
    long pings = 0;
    ~Connection() {
        if (display != nullptr) XCloseDisplay(display);
    }
};

std::unique_ptr<VirtualDisplay> VirtualDisplay::start(std::uint32_t width, std::uint32_t height) {
    if (std::system("command -v Xvfb >/dev/null 2>&1") != 0) {
        std::cout << "skipped: Xvfb is not installed (package xvfb)" << std::endl;
        return nullptr;
    }
    std::array<int, 2> pipe_ends{};
    if (pipe(pipe_ends.data()) != 0) return nullptr;
    const std::string screen = std::to_string(width) + "x" + std::to_string(height) + "x24";
    const std::string descriptor = std::to_string(pipe_ends[1]);
    const pid_t server = fork();
    if (server == 0) {
        close(pipe_ends[0]);
        execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", screen.c_str(), "-nolisten", "tcp",
               static_cast<char*>(nullptr));
        _exit(127);
    }
    close(pipe_ends[1]);
    std::unique_ptr<VirtualDisplay> display(new VirtualDisplay);
    display->server_ = server;
    const std::string number = read_display_number(pipe_ends[0]);
    close(pipe_ends[0]);
    if (number.empty()) {
        std::cout << "skipped: Xvfb does not start here" << std::endl;
        return nullptr;
    }
    display->name_ = ":" + number;
    display->connection_ = std::make_unique<Connection>();
    display->connection_->display = XOpenDisplay(display->name_.c_str());
    if (display->connection_->display == nullptr) return nullptr;
    XSetErrorHandler(ignore_error);
    return display;
}

VirtualDisplay::~VirtualDisplay() {
    connection_.reset();
    if (server_ <= 0) return;
    kill(server_, SIGTERM);
    waitpid(server_, nullptr, 0);
}

void VirtualDisplay::settle(double seconds) const {
    XSync(connection_->display, False);
    sleep_seconds(seconds);
}

bool VirtualDisplay::find_window(double seconds) {
    const auto start = Clock::now();
    while (since(start) < seconds) {
        Display* display = connection_->display;
        connection_->window = find_titled(display, DefaultRootWindow(display), "splice-view");
        if (connection_->window != 0) {
            // There is no window manager to give it the keyboard.
            XSetInputFocus(display, connection_->window, RevertToParent, CurrentTime);
            settle();
            return true;
        }
        sleep_seconds(0.05);
    }
    return false;
}

std::string VirtualDisplay::title() const {
    return title_of(connection_->display, connection_->window);
}

bool VirtualDisplay::wait_for_title(const std::string& wanted, double seconds) const {
    const auto start = Clock::now();
    while (since(start) < seconds) {
        if (title() == wanted) return true;
        sleep_seconds(0.01);
    }
    return false;
}

Picture VirtualDisplay::picture() const {
    Display* display = connection_->display;
    XSync(display, False);
    XWindowAttributes attributes{};
    Picture picture;
    if (XGetWindowAttributes(display, connection_->window, &attributes) == 0) return picture;
    const auto width = static_cast<unsigned>(attributes.width), height = static_cast<unsigned>(attributes.height);
    XImage* image = XGetImage(display, connection_->window, 0, 0, width, height, AllPlanes, ZPixmap);
    if (image == nullptr) return picture;
    picture.width = width;
    picture.height = height;
    for (int y = 0; y < attributes.height; ++y) {
        for (int x = 0; x < attributes.width; ++x) {
            const unsigned long pixel = XGetPixel(image, x, y);
            for (const int shift : {16, 8, 0})
                picture.rgba.push_back(static_cast<std::uint8_t>(pixel >> shift));
            picture.rgba.push_back(255);
        }
    }
    XDestroyImage(image);
    return picture;
}

// Window managers ask like this whether a window still listens (_NET_WM_PING). It answers when it comes to the event,
// so to all that were sent before, too.
bool VirtualDisplay::answers_ping(double seconds) const {
    Display* display = connection_->display;
    const Window root = DefaultRootWindow(display);
    const Atom ping = XInternAtom(display, "_NET_WM_PING", False);
    const long number = ++connection_->pings;
    XSelectInput(display, root, SubstructureNotifyMask);
    XEvent event = client_message(display, connection_->window, "WM_PROTOCOLS");
    event.xclient.data.l[0] = static_cast<long>(ping);
    event.xclient.data.l[1] = number;
    event.xclient.data.l[2] = static_cast<long>(connection_->window);
    XSendEvent(display, connection_->window, False, NoEventMask, &event);
    bool answered = false;
    const auto start = Clock::now();
    while (!answered && since(start) < seconds) {
        XSync(display, False);
        while (XPending(display) > 0) {
            XNextEvent(display, &event);
            answered =
                answered || (event.type == ClientMessage && event.xclient.window == root &&
                             event.xclient.data.l[0] == static_cast<long>(ping) && event.xclient.data.l[1] == number);
        }
        if (!answered) sleep_seconds(0.002);
    }
    XSelectInput(display, root, NoEventMask);
    return answered;
}

bool VirtualDisplay::caught_up(double seconds) const {
    // When the second comes, what the loop did after the first is done.
    return answers_ping(seconds) && answers_ping(seconds);
}

Picture VirtualDisplay::picture_when(const std::function<bool(const Picture&)>& wanted, double seconds) const {
    const auto start = Clock::now();
    caught_up(seconds);
    Picture last = picture();
    constexpr int still_for = 2;
    int still = 0;
    while (since(start) < seconds) {
        // Longer than the viewer waits after a move until it draws the picture whole again; then it has drawn it.
        sleep_seconds(0.3);
        caught_up(seconds);
        Picture now = picture();
        still = difference(last, now) == 0 ? still + 1 : 0;
        last = std::move(now);
        if (still >= still_for && wanted(last)) break;
    }
    return last;
}

Picture VirtualDisplay::still_picture() const {
    return picture_when([](const Picture&) { return true; });
}

void VirtualDisplay::move(int x, int y) {
    Display* display = connection_->display;
    int root_x = 0, root_y = 0;
    Window child = 0;
    XTranslateCoordinates(display, connection_->window, DefaultRootWindow(display), x, y, &root_x, &root_y, &child);
    XTestFakeMotionEvent(display, -1, root_x, root_y, CurrentTime);
    settle();
}

void VirtualDisplay::press(unsigned button) {
    XTestFakeButtonEvent(connection_->display, button, True, CurrentTime);
    settle();
}

void VirtualDisplay::release(unsigned button) {
    XTestFakeButtonEvent(connection_->display, button, False, CurrentTime);
    settle();
}

void VirtualDisplay::click(int x, int y, unsigned button) {
    move(x, y);
    press(button);
    release(button);
}

void VirtualDisplay::drag(int from_x, int from_y, int to_x, int to_y, unsigned button) {
    move(from_x, from_y);
    press(button);
    constexpr int steps = 6;
    for (int i = 1; i <= steps; ++i)
        move(from_x + (to_x - from_x) * i / steps, from_y + (to_y - from_y) * i / steps);
    release(button);
}

void VirtualDisplay::wheel(int notches) {
    for (int i = 0; i < std::abs(notches); ++i) {
        press(notches > 0 ? 4 : 5);
        release(notches > 0 ? 4 : 5);
    }
}

void VirtualDisplay::key(const char* name, bool shift) {
    Display* display = connection_->display;
    const KeyCode code = XKeysymToKeycode(display, XStringToKeysym(name));
    const KeyCode shift_code = XKeysymToKeycode(display, XK_Shift_L);
    if (shift) XTestFakeKeyEvent(display, shift_code, True, CurrentTime);
    XTestFakeKeyEvent(display, code, True, CurrentTime);
    settle();
    XTestFakeKeyEvent(display, code, False, CurrentTime);
    if (shift) XTestFakeKeyEvent(display, shift_code, False, CurrentTime);
    settle();
}

void VirtualDisplay::resize(unsigned width, unsigned height, double seconds_after) {
    XResizeWindow(connection_->display, connection_->window, width, height);
    settle(seconds_after);
}

void VirtualDisplay::say_minimised(bool minimised) {
    Display* display = connection_->display;
    const Atom state = XInternAtom(display, "WM_STATE", False);
    const std::array<long, 2> values{minimised ? IconicState : NormalState, 0};
    XChangeProperty(display, connection_->window, state, state, 32, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(values.data()), static_cast<int>(values.size()));
    settle();
}

// As any program that pastes: the selection's owner is asked to leave the text with a window of ours (ICCCM 2.4).
std::optional<std::string> VirtualDisplay::clipboard(double seconds) const {
    Display* display = connection_->display;
    const Window window = XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0);
    const Atom text = XInternAtom(display, "UTF8_STRING", False), here = XInternAtom(display, "PASTED", False);
    XConvertSelection(display, XInternAtom(display, "CLIPBOARD", False), text, here, window, CurrentTime);
    std::optional<std::string> pasted;
    const auto start = Clock::now();
    for (bool answered = false; !answered && since(start) < seconds;) {
        XSync(display, False);
        XEvent event{};
        while (XCheckTypedWindowEvent(display, window, SelectionNotify, &event) != 0) {
            answered = true;
            Atom type = 0;
            int format = 0;
            unsigned long count = 0, left = 0;
            unsigned char* bytes = nullptr;
            constexpr long most = 1 << 20;
            if (event.xselection.property == here &&
                XGetWindowProperty(display, window, here, 0, most, True, text, &type, &format, &count, &left, &bytes) ==
                    Success &&
                type == text && bytes != nullptr)
                pasted = std::string(reinterpret_cast<const char*>(bytes), count);
            if (bytes != nullptr) XFree(bytes);
        }
        if (!answered) sleep_seconds(0.01);
    }
    XDestroyWindow(display, window);
    return pasted;
}

bool VirtualDisplay::drop(const std::filesystem::path& file, int x, int y) {
    Display* display = connection_->display;
    int root_x = 0, root_y = 0;
    Window child = 0;
    XTranslateCoordinates(display, connection_->window, DefaultRootWindow(display), x, y, &root_x, &root_y, &child);
    return drop_file(display, connection_->window, "file://" + file.string(), root_x, root_y);
}

void VirtualDisplay::set_dots_per_inch(int dots) {
    Display* display = connection_->display;
    const std::string resources = "Xft.dpi:\t" + std::to_string(dots) + "\n";
    XChangeProperty(display, DefaultRootWindow(display), XA_RESOURCE_MANAGER, XA_STRING, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(resources.data()), static_cast<int>(resources.size()));
    settle();
}

void VirtualDisplay::ask_to_close() {
    Display* display = connection_->display;
    XEvent event = client_message(display, connection_->window, "WM_PROTOCOLS");
    event.xclient.data.l[0] = static_cast<long>(XInternAtom(display, "WM_DELETE_WINDOW", False));
    event.xclient.data.l[1] = CurrentTime;
    XSendEvent(display, connection_->window, False, NoEventMask, &event);
    settle();
}

void VirtualDisplay::destroy_window() {
    XDestroyWindow(connection_->display, connection_->window);
    settle();
}

double difference(const Picture& a, const Picture& b, int tolerance) {
    if (a.width != b.width || a.height != b.height || a.rgba.empty()) return 1;
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4)
        for (std::size_t channel = 0; channel < 3; ++channel) {
            if (std::abs(int{a.rgba[i + channel]} - int{b.rgba[i + channel]}) <= tolerance) continue;
            ++different;
            break;
        }
    return static_cast<double>(different) / static_cast<double>(a.rgba.size() / 4);
}

Picture cropped(const Picture& picture, std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height) {
    Picture part{width, height, {}};
    for (std::uint32_t row = y; row < y + height; ++row) {
        const auto first = picture.rgba.begin() + std::ptrdiff_t{4} * (std::ptrdiff_t{row} * picture.width + x);
        part.rgba.insert(part.rgba.end(), first, first + std::ptrdiff_t{4} * width);
    }
    return part;
}

}  // namespace splice::test
