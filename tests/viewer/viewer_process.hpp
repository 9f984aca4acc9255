// The viewer as a process that is watched and signaled while it runs.
#pragma once

#include "support/test_folder.hpp"
#include "support/test_paths.hpp"
#include "viewer/viewer_run.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <exception>
#include <string>
#include <thread>
#include <vector>

namespace tests
{

// For a new process: it ends with the one that made it, even if that crashes. Otherwise ctest would wait for it, since
// it holds the output of the test.
inline void end_with_parent(pid_t parent)
{
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent)
        ::_exit(127);
}

struct Ending
{
    int exit_code = -1; // -1: ended by a signal
    int signal = 0;     // that ended it
    long peak_kib = 0;  // of its memory
    std::string errors;
};

class ViewerProcess
{
public:
    // `prepare` runs in the new process before the viewer. Standard error goes to a file, unless `prepare` has another.
    template <typename Prepare>
    ViewerProcess(const std::vector<std::string>& arguments, Prepare prepare)
    {
        std::vector<std::string> all{program("viewer").string()};
        all.insert(all.end(), arguments.begin(), arguments.end());
        std::vector<char*> pointers;
        for (std::string& argument : all)
            pointers.push_back(argument.data());
        pointers.push_back(nullptr);
        const std::string errors = errors_.string();
        const pid_t parent = ::getpid();
        process_ = ::fork();
        if (process_ != 0)
            return;
        end_with_parent(parent);
        ::unsetenv("DISPLAY");
        ::unsetenv("WAYLAND_DISPLAY");
        ::dup2(::open("/dev/null", O_WRONLY), STDOUT_FILENO);
        ::dup2(::open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
        prepare();
        ::execv(pointers[0], pointers.data());
        ::_exit(127);
    }
    explicit ViewerProcess(const std::vector<std::string>& arguments) : ViewerProcess(arguments, [] {}) {}

    ~ViewerProcess()
    {
        if (process_ <= 0)
            return;
        const Ending ending = kill();
        if (std::uncaught_exceptions() > 0) // a requirement failed
            MESSAGE("the viewer ended with exit code ", ending.exit_code, ", signal ", ending.signal, ": ",
                    ending.errors);
    }
    ViewerProcess(const ViewerProcess&) = delete;
    ViewerProcess& operator=(const ViewerProcess&) = delete;

    // What it has written to standard error so far.
    [[nodiscard]] std::string errors() const { return text_of(errors_); }

    void send(int signal) const { ::kill(process_, signal); }

    // It cannot write beyond this many bytes of a file from now on.
    void limit_files(rlim_t bytes) const
    {
        const rlimit limit{bytes, bytes};
        ::prlimit(process_, RLIMIT_FSIZE, &limit, nullptr);
    }

    // False if it does not come true within a minute.
    template <typename Condition>
    static bool wait_until(Condition condition)
    {
        for (int i = 0; i < 6000; ++i)
        {
            if (condition())
                return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }

    // SIGKILL, unless it has ended by itself.
    Ending kill()
    {
        send(SIGKILL);
        return wait();
    }

    Ending wait()
    {
        int status = 0;
        rusage usage{};
        ::wait4(process_, &status, 0, &usage);
        process_ = -1;
        Ending ending;
        ending.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        ending.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
        ending.peak_kib = usage.ru_maxrss;
        ending.errors = text_of(errors_);
        return ending;
    }

private:
    TestFolder folder_;
    std::filesystem::path errors_ = folder_ / "errors";
    pid_t process_ = -1;
};

} // namespace tests
