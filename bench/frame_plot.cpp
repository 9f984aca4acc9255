#include "frame_plot.hpp"

#include "peers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace bench
{

namespace
{

// Pixels.
constexpr double k_width = 760;
constexpr double k_left = 250; // of the bars
constexpr double k_right = 690;
constexpr double k_top = 46;
constexpr double k_row = 19;
constexpr double k_bar = 13;
constexpr double k_title = 30; // above a group

// Of the axis, ms.
constexpr double k_least = 0.2;
constexpr double k_most = 500;

constexpr const char* k_own_color = "#1d6fa5";
constexpr const char* k_peer_color = "#b9bec4";
constexpr const char* k_goal_color = "#d0652b";

constexpr double k_goals[k_peer_sizes] = {0.5, 1.2, 5};      // ms
constexpr double k_self_goals[k_peer_sizes] = {0.8, 1.9, 8}; // ms, with self-collision

double x_of(double milliseconds)
{
    return k_left + (k_right - k_left) * std::log(milliseconds / k_least) / std::log(k_most / k_least);
}

template <typename... Values>
std::string formatted(const char* format, Values... values)
{
    std::array<char, 512> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

class Plot
{
public:
    void add_group(int side)
    {
        y_ += k_title;
        body_ += formatted("<text x='12' y='%.0f' class='title'>%d x %d vertices</text>\n", y_ - 6, side, side);
    }

    void add_bar(const std::string& name, double milliseconds, const char* color)
    {
        add_name(name);
        body_ += formatted("<rect x='%.0f' y='%.1f' width='%.1f' height='%.0f' fill='%s'/>\n", k_left, y_,
                           x_of(milliseconds) - k_left, k_bar, color);
        body_ += formatted("<text x='%.1f' y='%.1f'>%.3g ms</text>\n", x_of(milliseconds) + 5, y_ + 11, milliseconds);
        y_ += k_row;
    }

    void add_failure(const std::string& name)
    {
        add_name(name);
        body_ += formatted("<text x='%.1f' y='%.1f' class='note'>failed</text>\n", k_left + 5, y_ + 11);
        y_ += k_row;
    }

    // Across the bar that was added last.
    void mark_goal(double milliseconds)
    {
        body_ += formatted("<rect x='%.1f' y='%.1f' width='3' height='%.0f' fill='%s'/>\n", x_of(milliseconds) - 1.5,
                           y_ - k_row - 2, k_bar + 4, k_goal_color);
    }

    [[nodiscard]] std::string svg(const std::string& device) const
    {
        const double height = y_ + 14;
        std::string grid;
        for (const double tick : {0.2, 0.5, 1., 2., 5., 10., 20., 50., 100., 200., 500.})
            grid += formatted("<line x1='%.1f' y1='%.0f' x2='%.1f' y2='%.1f' stroke='#e4e6e8'/>\n"
                              "<text x='%.1f' y='%.0f' class='tick'>%.3g</text>\n",
                              x_of(tick), k_top, x_of(tick), height - 10, x_of(tick), k_top - 5, tick);
        return formatted("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %.0f %.0f' width='%.0f' "
                         "height='%.0f' font-family='sans-serif' font-size='12'>\n",
                         k_width, height, k_width, height) +
               "<style>.title{font-weight:bold;font-size:13px}.name{text-anchor:end}.note{fill:#777}"
               ".tick{text-anchor:middle;fill:#777;font-size:11px}</style>\n"
               "<rect width='100%' height='100%' fill='white'/>\n" +
               formatted("<text x='12' y='20' class='title'>Drape scene: ms per frame of 1/60 s on %s, orange: goal"
                         "</text>\n",
                         device.c_str()) +
               grid + body_ + "</svg>\n";
    }

private:
    void add_name(const std::string& name)
    {
        body_ += formatted("<text x='%.0f' y='%.1f' class='name'>%s</text>\n", k_left - 8, y_ + 11, name.c_str());
    }

    std::string body_;
    double y_ = k_top;
};

// Text of an element.
std::string escaped(const std::string& text)
{
    std::string result;
    for (const char c : text)
    {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else
            result += c;
    }
    return result;
}

} // namespace

voile::Result<std::string> plot_frames(const std::vector<CaseResult>& results)
{
    Plot plot;
    std::string device;
    for (size_t size = 0; size < k_peer_sizes; ++size)
    {
        plot.add_group(k_peer_sides[size]);
        for (const bool self_collision : {false, true})
        {
            const std::string name =
                "drape-" + std::to_string(k_peer_sides[size]) + (self_collision ? "-self" : "-verlet");
            const auto own = std::ranges::find(results, name, &CaseResult::name);
            if (own == results.end())
                return voile::Error{"the plot needs case " + name};
            device = own->device;
            const std::string suffix = self_collision ? ", self-collision" : "";
            plot.add_bar("Voile, Verlet" + suffix, own->frame(), k_own_color);
            plot.mark_goal((self_collision ? k_self_goals : k_goals)[size]);
            for (const Peer& peer : peers())
                if (peer.self_collision == self_collision && peer.frames[size] > 0)
                    plot.add_bar(peer.name + suffix, peer.frames[size], k_peer_color);
                else if (peer.self_collision == self_collision)
                    plot.add_failure(peer.name + suffix);
        }
    }
    return plot.svg(escaped(device));
}

} // namespace bench
