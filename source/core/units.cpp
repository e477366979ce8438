#include "core/units.h"

#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

namespace spindrift {
namespace {

// A factor to SI units, in which angles are degrees, and exponents of kg, m, s and degrees.
struct Unit {
    double factor = 1;
    std::array<int, 4> exponents{};
    bool operator==(const Unit&) const = default;
};

struct Symbol {
    std::string_view name;
    Unit unit;
    bool prefixed = false;  // may have a prefix
};

constexpr double Pound = 0.45359237, Foot = 0.3048, Psi = 6894.757293168361;
const Symbol Symbols[] = {
    {"m", {1, {0, 1}}, true},
    {"g", {1e-3, {1}}, true},
    {"s", {1, {0, 0, 1}}, true},
    {"rad", {180 / std::numbers::pi, {0, 0, 0, 1}}, true},
    {"N", {1, {1, 1, -2}}, true},
    {"Pa", {1, {1, -1, -2}}, true},
    {"bar", {1e5, {1, -1, -2}}, true},
    {"l", {1e-3, {0, 3}}, true},
    {"L", {1e-3, {0, 3}}, true},
    {"cc", {1e-6, {0, 3}}},
    {"deg", {1, {0, 0, 0, 1}}},
    {"degree", {1, {0, 0, 0, 1}}},
    {"degrees", {1, {0, 0, 0, 1}}},
    {"turn", {360, {0, 0, 0, 1}}},
    {"rev", {360, {0, 0, 0, 1}}},
    {"radians", {180 / std::numbers::pi, {0, 0, 0, 1}}},
    {"sec", {1, {0, 0, 1}}},
    {"seconds", {1, {0, 0, 1}}},
    {"min", {60, {0, 0, 1}}},
    {"h", {3600, {0, 0, 1}}},
    {"metre", {1, {0, 1}}},
    {"metres", {1, {0, 1}}},
    {"meter", {1, {0, 1}}},
    {"meters", {1, {0, 1}}},
    {"in", {Foot / 12, {0, 1}}},
    {"ft", {Foot, {0, 1}}},
    {"lb", {Pound, {1}}},
    {"t", {1e3, {1}}},
    {"atm", {101325, {1, -1, -2}}},
    {"psi", {Psi, {1, -1, -2}}},
};
constexpr std::pair<std::string_view, double> Prefixes[] = {
    {"n", 1e-9}, {"u", 1e-6}, {"m", 1e-3}, {"c", 1e-2}, {"d", 1e-1},
    {"da", 10},  {"h", 1e2},  {"k", 1e3},  {"M", 1e6},  {"G", 1e9}};

std::optional<Unit> symbol(std::string_view name) {
    for (const Symbol& s : Symbols)
        if (s.name == name) return s.unit;
    for (const Symbol& s : Symbols)
        for (const auto& [prefix, factor] : Prefixes)
            if (s.prefixed && name.size() == prefix.size() + s.name.size() &&
                name.starts_with(prefix) && name.ends_with(s.name))
                return Unit{factor * s.unit.factor, s.unit.exponents};
    return {};
}

// In plain letters; superscripts, the micro sign and the degree's come in UTF-8 or, from older
// programs, as single bytes.
std::string plain(std::string text) {
    constexpr std::pair<std::string_view, std::string_view> Spellings[] = {
        {"²", "2"}, {"³", "3"},    {"⁻", "-"},    {"¹", "1"},    {"−", "-"},     {"µ", "u"},
        {"μ", "u"}, {"°", "deg"},  {"·", " "},    {"⋅", " "},    {"**", ""},     {"^", ""},
        {"*", " "}, {"\xb2", "2"}, {"\xb3", "3"}, {"\xb5", "u"}, {"\xb0", "deg"}};
    for (const auto& [from, to] : Spellings)
        for (size_t at = text.find(from); at != std::string::npos;
             at = text.find(from, at + to.size()))
            text.replace(at, from.size(), to);
    return text;
}

// Factors with exponents behind them, "m", "m3", "s-1"; one behind a stroke, or all in parentheses
// behind it, divide.
std::optional<Unit> parse(const std::string& written) {
    const std::string text = plain(written);
    Unit product;
    int sign = 1;
    bool group = false, any = false;
    for (size_t at = 0; at < text.size();) {
        const char c = text[at];
        if (std::isalpha(static_cast<unsigned char>(c))) {
            size_t end = at;
            while (end < text.size() && std::isalpha(static_cast<unsigned char>(text[end]))) ++end;
            const std::optional<Unit> factor = symbol(std::string_view(text).substr(at, end - at));
            if (!factor) return {};
            char* rest = nullptr;
            const long power = std::strtol(&text[end], &rest, 10);
            const bool raised =
                rest != &text[end] && !std::isspace(static_cast<unsigned char>(text[end]));
            if (raised && (power == 0 || std::abs(power) > 9)) return {};
            const int exponent = sign * (raised ? int(power) : 1);
            product.factor *= std::pow(factor->factor, exponent);
            for (size_t k = 0; k < product.exponents.size(); ++k)
                product.exponents[k] += exponent * factor->exponents[k];
            at = raised ? size_t(rest - text.data()) : end;
            any = true;
            if (!group) sign = 1;
            continue;
        }
        if (c == '/' && sign == 1 && any)
            sign = -1;
        else if (c == '(')
            group = true;
        else if (c == ')')
            group = false, sign = 1;
        else if (c != ' ' ||
                 (sign < 0 && !group && text.find_first_not_of(' ', at) == std::string::npos))
            return {};
        ++at;
    }
    if (!any || (sign < 0 && !group)) return {};
    return product;
}

const std::vector<std::string>& common(const std::string& to) {
    static const std::pair<std::string, std::vector<std::string>> Quantities[] = {
        {"m", {"m", "mm", "cm", "um", "km", "in", "ft"}},
        {"m/s", {"m/s", "cm/s", "mm/s", "km/h", "ft/s"}},
        {"kg/m³", {"kg/m³", "g/cm³", "g/cc", "g/ml", "kg/l"}},
        {"Pa", {"Pa", "hPa", "kPa", "MPa", "bar", "mbar", "atm", "psi"}},
        {"kg", {"kg", "g", "mg"}},
        {"s", {"s", "ms", "us", "min", "h"}},
        {"degrees", {"degrees", "deg", "rad", "turn"}},
        {"degrees/s", {"degrees/s", "deg/s", "rad/s", "turn/s"}},
    };
    static const std::vector<std::string> none;
    for (const auto& [name, units] : Quantities)
        if (plain(name) == plain(to)) return units;
    return none;
}

std::string inCapitals(std::string text) {
    for (char& c : text) c = char(std::toupper(static_cast<unsigned char>(c)));
    return text;
}

}  // namespace

std::optional<double> unitFactor(const std::string& unit, const std::string& to) {
    if (unit == to) return 1;
    const std::optional<Unit> goal = parse(to);
    std::optional<Unit> given = parse(unit);
    for (const std::string& name : common(to))
        if (!given && plain(unit) == plain(inCapitals(name))) given = parse(name);
    if (!goal || !given || goal->exponents != given->exponents) return {};
    return given->factor / goal->factor;
}

std::string commonUnits(const std::string& to) {
    std::string text;
    for (const std::string& name : common(to)) text += (text.empty() ? "" : ", ") + name;
    return text;
}

}  // namespace spindrift
