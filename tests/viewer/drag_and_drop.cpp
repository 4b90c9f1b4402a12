#include "tests/viewer/drag_and_drop.h"

#include <X11/Xatom.h>

#include <chrono>
#include <thread>

namespace splice::test {

namespace {

class Sender {
  public:
    Sender(Display* display, Window target, const std::string& uri)
        : display_(display),
          target_(target),
          text_(uri + "\r\n"),
          source_(XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0)) {
        XSetSelectionOwner(display, atom("XdndSelection"), source_, CurrentTime);
    }
    ~Sender() { XDestroyWindow(display_, source_); }
    Sender(const Sender&) = delete;
    Sender& operator=(const Sender&) = delete;

    bool run(int x, int y) {
        constexpr long version = 5L << 24;
        tell("XdndEnter", version, static_cast<long>(atom("text/uri-list")), 0, 0);
        tell("XdndPosition", 0, (static_cast<long>(x) << 16) | y, CurrentTime,
             static_cast<long>(atom("XdndActionCopy")));
        if (!wait_for("XdndStatus")) return false;
        tell("XdndDrop", 0, CurrentTime, 0, 0);
        return wait_for("XdndFinished");
    }

  private:
    Atom atom(const char* name) const { return XInternAtom(display_, name, False); }

    void tell(const char* what, long a, long b, long c, long d) const {
        XEvent event{};
        event.xclient.type = ClientMessage;
        event.xclient.window = target_;
        event.xclient.message_type = atom(what);
        event.xclient.format = 32;
        event.xclient.data.l[0] = static_cast<long>(source_);
        event.xclient.data.l[1] = a;
        event.xclient.data.l[2] = b;
        event.xclient.data.l[3] = c;
        event.xclient.data.l[4] = d;
        XSendEvent(display_, target_, False, NoEventMask, &event);
        XFlush(display_);
    }

    // Meanwhile, hands out what is dropped to who asks.
    bool wait_for(const char* answer) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (std::chrono::steady_clock::now() < end) {
            while (XPending(display_) > 0) {
                XEvent event{};
                XNextEvent(display_, &event);
                if (event.type == SelectionRequest) give(event.xselectionrequest);
                if (event.type == ClientMessage && event.xclient.message_type == atom(answer))
                    return event.xclient.data.l[1] != 0;  // bit 0 by the protocol; GLFW puts a count of bytes there
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }

    void give(const XSelectionRequestEvent& request) const {
        XChangeProperty(display_, request.requestor, request.property, request.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(text_.data()), static_cast<int>(text_.size()));
        XEvent event{};
        event.xselection.type = SelectionNotify;
        event.xselection.requestor = request.requestor;
        event.xselection.selection = request.selection;
        event.xselection.target = request.target;
        event.xselection.property = request.property;
        event.xselection.time = request.time;
        XSendEvent(display_, request.requestor, False, NoEventMask, &event);
        XFlush(display_);
    }

    Display* display_;
    Window target_;
    std::string text_;
    Window source_;
};

}  // namespace

bool drop_file(Display* display, Window target, const std::string& uri, int root_x, int root_y) {
    return Sender(display, target, uri).run(root_x, root_y);
}

}  // namespace splice::test
