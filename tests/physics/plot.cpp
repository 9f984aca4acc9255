#include "physics/plot.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace physics
{

namespace
{

constexpr double k_width = 640;
constexpr double k_height = 420;
constexpr double k_left = 80;
constexpr double k_right = 150; // of the legend
constexpr double k_top = 40;
constexpr double k_bottom = 60;
constexpr std::array k_colors = {"#1f5fa8", "#c8542b", "#3a8f4d", "#8a4fa3", "#b08a1e", "#4a4a4a"};

std::string number(double value, const char* format = "%.1f")
{
    char text[32];
    std::snprintf(text, sizeof(text), format, value);
    return text;
}

// One axis: maps values to points of the picture, with its ticks.
struct Axis
{
    double low = 0;
    double high = 1;
    bool logarithmic = false;
    double from = 0; // points
    double to = 1;

    [[nodiscard]] double scaled(double v) const { return logarithmic ? std::log10(v) : v; }
    [[nodiscard]] double at(double v) const { return from + (scaled(v) - low) / (high - low) * (to - from); }

    [[nodiscard]] std::vector<double> ticks() const
    {
        double step = std::pow(10, std::floor(std::log10((high - low) / 3)));
        while ((high - low) / step > 7)
            step *= step * 3 > high - low ? 2 : 2.5;
        if (logarithmic)
            step = 1;
        std::vector<double> result;
        for (double t = std::ceil(low / step - 1e-9) * step; t <= high + 1e-9 * step; t += step)
            result.push_back(logarithmic ? std::pow(10, t) : std::abs(t) < 1e-9 * step ? 0 : t);
        return result;
    }
};

Axis make_axis(const Plot& plot, std::vector<double> Curve::*values, double from, double to)
{
    Axis axis{1e300, -1e300, plot.logarithmic, from, to};
    for (const Curve& curve : plot.curves)
        for (const double v : curve.*values)
        {
            axis.low = std::min(axis.low, axis.scaled(v));
            axis.high = std::max(axis.high, axis.scaled(v));
        }
    const double margin = std::max(0.04 * (axis.high - axis.low), 1e-12);
    axis.low -= margin;
    axis.high += margin;
    return axis;
}

void widen(Axis& axis, double range)
{
    const double more = 0.5 * (range - (axis.high - axis.low));
    axis.low -= more;
    axis.high += more;
}

void text(std::ostream& out, double x, double y, const char* anchor, const std::string& what, const char* more = "")
{
    out << "<text x=\"" << number(x) << "\" y=\"" << number(y) << "\" text-anchor=\"" << anchor << "\"" << more << ">"
        << what << "</text>\n";
}

void write_axes(std::ostream& out, const Plot& plot, const Axis& x, const Axis& y)
{
    for (const double t : x.ticks())
    {
        out << "<path class=\"grid\" d=\"M" << number(x.at(t)) << " " << k_top << "V" << k_height - k_bottom
            << "\"/>\n";
        text(out, x.at(t), k_height - k_bottom + 18, "middle", number(t, "%.4g"));
    }
    for (const double t : y.ticks())
    {
        out << "<path class=\"grid\" d=\"M" << k_left << " " << number(y.at(t)) << "H" << k_width - k_right << "\"/>\n";
        text(out, k_left - 8, y.at(t) + 4, "end", number(t, "%.4g"));
    }
    text(out, 0.5 * (k_left + k_width - k_right), k_height - 18, "middle", plot.x_label);
    const double middle = 0.5 * (k_top + k_height - k_bottom);
    text(out, 18, middle, "middle", plot.y_label, (" transform=\"rotate(-90 18 " + number(middle) + ")\"").c_str());
    text(out, k_left, 24, "start", plot.title, " font-weight=\"bold\"");
}

void write_curve(std::ostream& out, const Curve& curve, const char* color, const Axis& x, const Axis& y)
{
    if (curve.points)
    {
        for (size_t i = 0; i < curve.x.size(); ++i)
            out << "<circle cx=\"" << number(x.at(curve.x[i])) << "\" cy=\"" << number(y.at(curve.y[i]))
                << "\" r=\"3\" fill=\"" << color << "\"/>\n";
        return;
    }
    out << "<polyline fill=\"none\" stroke-width=\"1.6\" stroke=\"" << color << "\" points=\"";
    for (size_t i = 0; i < curve.x.size(); ++i)
        out << number(x.at(curve.x[i])) << "," << number(y.at(curve.y[i])) << " ";
    out << "\"/>\n";
}

} // namespace

bool write_svg(const Plot& plot, const std::filesystem::path& folder)
{
    Axis x = make_axis(plot, &Curve::x, k_left, k_width - k_right);
    Axis y = make_axis(plot, &Curve::y, k_height - k_bottom, k_top);
    if (plot.even)
    {
        const double meters = std::max((x.high - x.low) / (x.to - x.from), (y.high - y.low) / (y.from - y.to));
        widen(x, meters * (x.to - x.from));
        widen(y, meters * (y.from - y.to));
    }
    std::ostringstream out;
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << k_width << " " << k_height
        << "\" font-family=\"sans-serif\" font-size=\"13\">\n<style>.grid{stroke:#ddd;fill:none}</style>\n"
        << "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    write_axes(out, plot, x, y);
    std::vector<std::string> names; // one color per name
    for (const Curve& curve : plot.curves)
    {
        auto found = std::find(names.begin(), names.end(), curve.name);
        const bool added = found == names.end();
        const auto index = static_cast<size_t>(found - names.begin());
        const char* color = k_colors[index % k_colors.size()];
        if (added)
        {
            names.push_back(curve.name);
            const double line = k_top + 14 + 20 * static_cast<double>(index);
            out << "<rect x=\"" << k_width - k_right + 12 << "\" y=\"" << number(line - 6)
                << "\" width=\"14\" height=\"3\" fill=\"" << color << "\"/>\n";
            text(out, k_width - k_right + 32, line, "start", curve.name);
        }
        write_curve(out, curve, color, x, y);
    }
    out << "</svg>\n";
    std::ofstream file(folder / (plot.file + ".svg"));
    file << out.str();
    return static_cast<bool>(file.flush());
}

} // namespace physics
