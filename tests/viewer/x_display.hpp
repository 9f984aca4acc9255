// A virtual display, with a client that does what a user and a window manager do: keys, mouse, resize, minimize, close.
#pragma once

#include "voile/engine/assets/image_file.hpp"

#include <string>
#include <sys/types.h>

struct _XDisplay; // of Xlib, whose header defines words as macros

namespace tests
{

// Xvfb, ended with its owner.
class XServer
{
public:
    XServer();
    ~XServer();
    XServer(const XServer&) = delete;
    XServer& operator=(const XServer&) = delete;

    [[nodiscard]] const std::string& name() const { return name_; } // for the variable DISPLAY; empty: it did not start

private:
    pid_t process_ = -1;
    std::string name_;
};

// One window of the display, found by the start of its title.
class XWindow
{
public:
    XWindow(const XServer& server, std::string title_start);
    ~XWindow();
    XWindow(const XWindow&) = delete;
    XWindow& operator=(const XWindow&) = delete;

    // True once the window is there. False after a minute.
    bool wait();
    [[nodiscard]] std::string title();
    // True once the title has that part. False after a minute.
    bool wait_for_title(const std::string& part, bool contained = true);

    void press(unsigned long key, bool control = false); // a key symbol, XK_...
    void hold(unsigned long key, bool down);
    void move(int x, int y);                     // the cursor, pixels in the window
    void button(unsigned int number, bool down); // 1 left, 2 middle, 3 right, 4 and 5 the wheel
    void drop(const std::string& path);          // a file, at the cursor, by the XDND protocol
    void resize(unsigned int width, unsigned int height);
    void minimize();
    void restore();
    void close(); // as by its button
    [[nodiscard]] voile::engine::Picture picture();

private:
    unsigned long find();
    void focus();
    void set_state(long state);
    void send(const char* type, long a, long b = 0, long c = 0, long d = 0, long e = 0);

    _XDisplay* display_ = nullptr;
    unsigned long window_ = 0;
    std::string title_start_;
};

} // namespace tests
