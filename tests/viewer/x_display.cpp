// XServer and XWindow.
#include "viewer/x_display.hpp"

#include "viewer/viewer_process.hpp"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>
#include <X11/keysym.h>

#include <array>
#include <cstdlib>
#include <cstring>

namespace tests
{

XServer::XServer()
{
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0)
        return;
    const pid_t parent = ::getpid();
    process_ = ::fork();
    if (process_ == 0)
    {
        end_with_parent(parent);
        ::close(ends[0]);
        ::dup2(::open("/dev/null", O_WRONLY), STDERR_FILENO);
        const std::string end = std::to_string(ends[1]);
        ::execlp("Xvfb", "Xvfb", "-displayfd", end.c_str(), "-screen", "0", "1280x800x24", "-nolisten", "tcp", nullptr);
        ::_exit(127);
    }
    ::close(ends[1]);
    char letter = 0;
    std::string number;
    while (::read(ends[0], &letter, 1) == 1 && letter != '\n')
        number.push_back(letter);
    ::close(ends[0]);
    if (!number.empty())
        name_ = ":" + number;
}

XServer::~XServer()
{
    if (process_ <= 0)
        return;
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
}

XWindow::XWindow(const XServer& server, std::string title_start)
    : display_(XOpenDisplay(server.name().c_str())), title_start_(std::move(title_start))
{
    // A window may go while it is asked for: the requests fail, and Xlib would end the program.
    XSetErrorHandler([](Display*, XErrorEvent*) { return 0; });
}

XWindow::~XWindow()
{
    if (display_ != nullptr)
        XCloseDisplay(display_);
}

unsigned long XWindow::find()
{
    Window root = 0;
    Window parent = 0;
    Window* children = nullptr;
    unsigned int count = 0;
    Window found = 0;
    XQueryTree(display_, DefaultRootWindow(display_), &root, &parent, &children, &count);
    for (unsigned int i = 0; i < count; ++i)
    {
        char* name = nullptr;
        XWindowAttributes attributes{};
        XGetWindowAttributes(display_, children[i], &attributes);
        if (XFetchName(display_, children[i], &name) != 0 && std::string(name).starts_with(title_start_) &&
            attributes.map_state == IsViewable)
            found = children[i];
        XFree(name);
    }
    XFree(children);
    return found;
}

bool XWindow::wait()
{
    if (display_ == nullptr || !ViewerProcess::wait_until([&] { return (window_ = find()) != 0; }))
        return false;
    focus();
    return true;
}

// Without a window manager nobody gives the focus.
void XWindow::focus()
{
    XSetInputFocus(display_, window_, RevertToParent, CurrentTime);
    XSync(display_, False);
}

std::string XWindow::title()
{
    char* name = nullptr;
    if (XFetchName(display_, window_, &name) == 0)
        return {};
    std::string result = name;
    XFree(name);
    return result;
}

bool XWindow::wait_for_title(const std::string& part, bool contained)
{
    return ViewerProcess::wait_until([&] { return (title().find(part) != std::string::npos) == contained; });
}

void XWindow::hold(unsigned long key, bool down)
{
    XTestFakeKeyEvent(display_, XKeysymToKeycode(display_, key), down ? True : False, CurrentTime);
    XSync(display_, False);
}

void XWindow::press(unsigned long key, bool control)
{
    if (control)
        hold(XK_Control_L, true);
    hold(key, true);
    hold(key, false);
    if (control)
        hold(XK_Control_L, false);
}

void XWindow::move(int x, int y)
{
    int root_x = 0;
    int root_y = 0;
    Window child = 0;
    XTranslateCoordinates(display_, window_, DefaultRootWindow(display_), x, y, &root_x, &root_y, &child);
    XTestFakeMotionEvent(display_, -1, root_x, root_y, CurrentTime);
    XSync(display_, False);
}

void XWindow::button(unsigned int number, bool down)
{
    XTestFakeButtonEvent(display_, number, down ? True : False, CurrentTime);
    XSync(display_, False);
}

void XWindow::resize(unsigned int width, unsigned int height)
{
    XResizeWindow(display_, window_, width, height);
    XSync(display_, False);
}

void XWindow::set_state(long state)
{
    const Atom property = XInternAtom(display_, "WM_STATE", False);
    const std::array<long, 2> value{state, 0};
    XChangeProperty(display_, window_, property, property, 32, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(value.data()), 2);
}

// What a window manager does (ICCCM 4.1.4).
void XWindow::minimize()
{
    XUnmapWindow(display_, window_);
    set_state(IconicState);
    XSync(display_, False);
}

void XWindow::restore()
{
    XMapWindow(display_, window_);
    set_state(NormalState);
    XSync(display_, False);
    ViewerProcess::wait_until([&] { return find() == window_; });
    focus();
}

void XWindow::send(const char* type, long a, long b, long c, long d, long e)
{
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = window_;
    event.xclient.message_type = XInternAtom(display_, type, False);
    event.xclient.format = 32;
    const std::array<long, 5> values{a, b, c, d, e};
    std::memcpy(event.xclient.data.l, values.data(), sizeof(values));
    XSendEvent(display_, window_, False, NoEventMask, &event);
    XSync(display_, False);
}

void XWindow::close()
{
    send("WM_PROTOCOLS", static_cast<long>(XInternAtom(display_, "WM_DELETE_WINDOW", False)));
}

// The source's side of XDND, version 5: enter, position, drop; then the target asks for the list of files.
void XWindow::drop(const std::string& path)
{
    const Window source = XCreateSimpleWindow(display_, DefaultRootWindow(display_), 0, 0, 1, 1, 0, 0, 0);
    const Atom selection = XInternAtom(display_, "XdndSelection", False);
    const Atom list = XInternAtom(display_, "text/uri-list", False);
    const auto from = static_cast<long>(source);
    XSetSelectionOwner(display_, selection, source, CurrentTime);
    send("XdndEnter", from, 5L << 24, static_cast<long>(list));
    send("XdndPosition", from, 0, (100L << 16) | 100, CurrentTime,
         static_cast<long>(XInternAtom(display_, "XdndActionCopy", False)));
    send("XdndDrop", from, 0, CurrentTime);
    const std::string text = "file://" + path + "\r\n";
    ViewerProcess::wait_until(
        [&]
        {
            XEvent event{};
            while (XCheckTypedEvent(display_, SelectionRequest, &event) != 0)
            {
                const XSelectionRequestEvent& request = event.xselectionrequest;
                XChangeProperty(display_, request.requestor, request.property, request.target, 8, PropModeReplace,
                                reinterpret_cast<const unsigned char*>(text.data()), static_cast<int>(text.size()));
                XEvent answer{};
                answer.xselection.type = SelectionNotify;
                answer.xselection.requestor = request.requestor;
                answer.xselection.selection = request.selection;
                answer.xselection.target = request.target;
                answer.xselection.property = request.property;
                answer.xselection.time = request.time;
                XSendEvent(display_, request.requestor, False, NoEventMask, &answer);
                XSync(display_, False);
                return true;
            }
            return false;
        });
    // The source lives until the target has finished.
    ViewerProcess::wait_until(
        [&]
        {
            XEvent event{};
            bool finished = false;
            while (XCheckTypedWindowEvent(display_, source, ClientMessage, &event) != 0)
                finished |= event.xclient.message_type == XInternAtom(display_, "XdndFinished", False);
            return finished;
        });
    XDestroyWindow(display_, source);
}

voile::engine::Picture XWindow::picture()
{
    XWindowAttributes attributes{};
    XGetWindowAttributes(display_, window_, &attributes);
    XImage* image = XGetImage(display_, window_, 0, 0, static_cast<unsigned int>(attributes.width),
                              static_cast<unsigned int>(attributes.height), AllPlanes, ZPixmap);
    voile::engine::Picture picture{
        static_cast<uint32_t>(attributes.width), static_cast<uint32_t>(attributes.height), {}};
    if (image == nullptr)
        return picture;
    for (int y = 0; y < attributes.height; ++y)
        for (int x = 0; x < attributes.width; ++x)
        {
            const unsigned long pixel = XGetPixel(image, x, y);
            for (const unsigned long part : {pixel >> 16, pixel >> 8, pixel, 255UL})
                picture.rgba.push_back(static_cast<uint8_t>(part & 255));
        }
    XDestroyImage(image);
    return picture;
}

} // namespace tests
