#include "scene/suggest.h"

#include <algorithm>

namespace spindrift {

// Optimal string alignment, three rows of the table at a time.
int editDistance(std::string_view a, std::string_view b) {
    std::vector<int> beforeLast(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j) last[j] = int(j);
    for (size_t i = 1; i <= a.size(); ++i) {
        row[0] = int(i);
        for (size_t j = 1; j <= b.size(); ++j) {
            const int replace = last[j - 1] + (a[i - 1] != b[j - 1]);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, replace});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], beforeLast[j - 2] + 1);
        }
        std::swap(beforeLast, last);
        std::swap(last, row);
    }
    return last[b.size()];
}

std::string nearestName(std::string_view wrong, const std::vector<std::string>& names) {
    constexpr size_t Longest = 80;  // nobody mistypes more than that; keeps absurd input cheap
    if (wrong.size() > Longest) return "";
    std::string best;
    int smallest = std::max(2, int(wrong.size()) / 3) + 1;
    for (const std::string& name : names) {
        // The beginning of a name is one mistake: the rest is missing.
        const bool begun = wrong.size() >= 3 && name.starts_with(wrong);
        const int distance = begun ? 1 : editDistance(wrong, name);
        // A name of which nothing is left is no suggestion.
        if (distance >= smallest || distance >= int(name.size())) continue;
        smallest = distance;
        best = name;
    }
    return best;
}

std::string listed(const std::vector<std::string>& names, std::string_view separator) {
    std::string text;
    for (const std::string& name : names) {
        if (!text.empty()) text += separator;
        text += name;
    }
    return text;
}

}  // namespace spindrift
