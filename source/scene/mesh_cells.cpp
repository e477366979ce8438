#include "scene/mesh_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <tuple>
#include <utility>

namespace spindrift {
namespace {

constexpr double Turn = 2 * std::numbers::pi;
constexpr int MostOrders = 5040, MostAttempts = 100;

// Behind a sheet (0) or before it (1): what comes after it, or what was before it, going around the
// edge against the clock.
int sideAfter(const Sheet& s) { return 2 * s.patch + (s.upward ? 1 : 0); }
int sideBefore(const Sheet& s) { return 2 * s.patch + (s.upward ? 0 : 1); }

// By angle, beginning after the widest gap.
void sortAround(std::vector<Sheet>& sheets) {
    std::sort(sheets.begin(), sheets.end(),
              [](const Sheet& a, const Sheet& b) { return a.angle < b.angle; });
    size_t first = 0;
    double widest = sheets.front().angle + Turn - sheets.back().angle;
    for (size_t i = 1; i < sheets.size(); ++i)
        if (const double gap = sheets[i].angle - sheets[i - 1].angle; gap > widest)
            widest = gap, first = i;
    for (size_t i = 0; i < first; ++i) sheets[i].angle += Turn;
    std::rotate(sheets.begin(), sheets.begin() + long(first), sheets.end());
}

// Where sheets that lie on each other begin, and the end.
std::vector<size_t> tiesOf(const std::vector<Sheet>& sheets) {
    std::vector<size_t> begins{0};
    for (size_t i = 1; i < sheets.size(); ++i)
        if (sheets[i].angle - sheets[i - 1].angle > sheets[i].doubt + sheets[i - 1].doubt)
            begins.push_back(i);
    begins.push_back(sheets.size());
    return begins;
}

// In the order in which those that lie on each other are tried.
bool comesFirst(const Sheet& a, const Sheet& b) {
    return std::tie(a.rank, a.upward) < std::tie(b.rank, b.upward);
}

// The next order of sheets that lie on each other; false after the last.
bool nextOrder(std::vector<Sheet>& sheets, const std::vector<size_t>& ties) {
    for (size_t t = 0; t + 1 < ties.size(); ++t)
        if (std::next_permutation(sheets.begin() + long(ties[t]),
                                  sheets.begin() + long(ties[t + 1]), comesFirst))
            return true;
    return false;
}

}  // namespace

MeshCells::Sets::Sets(size_t count) : parents_(count), sizes_(count, 1), odd_(count, 0) {
    std::iota(parents_.begin(), parents_.end(), 0);
}

int MeshCells::Sets::rootOf(int a) const {
    while (parents_[size_t(a)] != a) a = parents_[size_t(a)];
    return a;
}

bool MeshCells::Sets::parityOf(int a) const {
    bool odd = false;
    for (; parents_[size_t(a)] != a; a = parents_[size_t(a)]) odd ^= bool(odd_[size_t(a)]);
    return odd;
}

bool MeshCells::Sets::join(int a, int b, bool odd) {
    odd ^= parityOf(a) ^ parityOf(b);
    a = rootOf(a), b = rootOf(b);
    if (a == b) return !odd;
    if (sizes_[size_t(a)] > sizes_[size_t(b)]) std::swap(a, b);
    parents_[size_t(a)] = b, odd_[size_t(a)] = odd, sizes_[size_t(b)] += sizes_[size_t(a)];
    steps_.push_back(a);
    return true;
}

void MeshCells::Sets::backTo(size_t steps) {
    for (; steps_.size() > steps; steps_.pop_back()) {
        const size_t a = size_t(steps_.back());
        sizes_[size_t(parents_[a])] -= sizes_[a], parents_[a] = int(a), odd_[a] = 0;
    }
}

MeshCells::MeshCells(std::vector<Patch> patches)
    : patches_(std::move(patches)),
      cells_(2 * patches_.size()),
      groups_(2 * patches_.size()),
      outside_(2 * patches_.size(), -1),
      depth_(2 * patches_.size(), 0),
      most_(depth_),
      straight_(depth_),
      bent_(depth_) {
    for (int p = 0; p < int(patches_.size()); ++p)
        groups_.join(2 * p, 2 * p + 1, patches_[size_t(p)].times % 2 == 1);
}

void MeshCells::meet(std::vector<Sheet> sheets) {
    sortAround(sheets);
    edges_.push_back(std::move(sheets));
}

// What is between one sheet and the next is one cell. False: it can't be.
bool MeshCells::tryOrder(const std::vector<Sheet>& sheets) {
    for (size_t i = 0; i < sheets.size(); ++i) {
        const int after = sideAfter(sheets[i]),
                  before = sideBefore(sheets[(i + 1) % sheets.size()]);
        cells_.join(after, before, false);
        if (!groups_.join(after, before, false)) return false;
    }
    return true;
}

// Of the orders that sheets on each other may have, the one that makes the fewest cells one.
bool MeshCells::place(std::vector<Sheet>& sheets) {
    const std::vector<size_t> ties = tiesOf(sheets);
    const size_t cells = cells_.steps(), groups = groups_.steps();
    for (size_t t = 0; t + 1 < ties.size(); ++t)
        std::sort(sheets.begin() + long(ties[t]), sheets.begin() + long(ties[t + 1]), comesFirst);
    std::vector<Sheet> best;
    size_t fewest = 0;
    int orders = 0;
    do {
        if (tryOrder(sheets) && (best.empty() || cells_.steps() < fewest))
            best = sheets, fewest = cells_.steps();
        cells_.backTo(cells), groups_.backTo(groups);
    } while (++orders < MostOrders && nextOrder(sheets, ties));
    if (best.empty()) return false;
    sheets = best;
    return tryOrder(sheets);
}

// Whether four go straight on, two and two: solids that cross.
void MeshCells::noteCrossing(const std::vector<Sheet>& sheets) {
    bool crosses = sheets.size() == 4;
    for (size_t i = 0; i < 2 && crosses; ++i)
        crosses = std::abs(sheets[i + 2].angle - sheets[i].angle - Turn / 2) <=
                  sheets[i].doubt + sheets[i + 2].doubt;
    for (const Sheet& s : sheets) crosses = crosses && patches_[size_t(s.patch)].times == 1;
    for (const Sheet& s : sheets)
        for (const int side : {0, 1})
            ++(crosses ? straight_ : bent_)[size_t(cellOf(s.patch, side))];
}

// Seen from within each cell its walls enclose its volume; from the outside all cells together do.
double MeshCells::findOutside() {
    std::vector<double> volumes(2 * patches_.size());
    outside_.assign(volumes.size(), -1);
    for (int p = 0; p < int(patches_.size()); ++p) {
        volumes[size_t(cellOf(p, 0))] += patches_[size_t(p)].volume;
        volumes[size_t(cellOf(p, 1))] -= patches_[size_t(p)].volume;
    }
    for (int s = 0; s < int(volumes.size()); ++s) {
        int& outside = outside_[size_t(groups_.rootOf(s))];
        const int cell = cells_.rootOf(s);
        if (outside < 0 || volumes[size_t(cell)] < volumes[size_t(outside)]) outside = cell;
    }
    double insideOut = 0;
    for (int s = 0; s < int(volumes.size()); ++s)
        if (outside_[size_t(groups_.rootOf(s))] != s)
            insideOut += std::max(-volumes[size_t(s)], 0.0);
    return insideOut;
}

// As many solids as sheets on the shortest way out; no sheet is there more often than these need.
void MeshCells::findMost() {
    constexpr int Far = 1 << 28;
    for (int s = 0; s < int(most_.size()); ++s)
        most_[size_t(s)] = outside_[size_t(groups_.rootOf(s))] == s ? 0 : Far;
    for (bool changes = true; changes;) {
        changes = false;
        for (int p = 0; p < int(patches_.size()); ++p) {
            int &a = most_[size_t(cellOf(p, 0))], &b = most_[size_t(cellOf(p, 1))];
            const int times = patches_[size_t(p)].times;
            if (a > b + times) a = b + times, changes = true;
            if (b > a + times) b = a + times, changes = true;
        }
    }
    for (int p = 0; p < int(patches_.size()); ++p) {
        const int sum = most_[size_t(cellOf(p, 0))] + most_[size_t(cellOf(p, 1))];
        int& times = patches_[size_t(p)].times;
        while (times > sum) times -= 2;
    }
}

bool MeshCells::isCrossing(int cell) const {
    return straight_[size_t(cell)] > 0 && bent_[size_t(cell)] == 0;
}

void MeshCells::raise() {
    bool changes = true;
    for (int round = 0; round < 100 && changes; ++round) {
        changes = false;
        for (int p = 0; p < int(patches_.size()); ++p) {
            const int times = patches_[size_t(p)].times;
            size_t low = size_t(cellOf(p, 0)), high = size_t(cellOf(p, 1));
            if (depth_[low] > depth_[high]) std::swap(low, high);
            const auto canRise = [&](size_t cell) { return depth_[cell] + 2 <= most_[cell]; };
            const bool tooFew =
                depth_[low] + depth_[high]<times, tooFar = depth_[high] - depth_[low]> times;
            if (!tooFew && !tooFar) continue;
            const size_t cell = tooFar || canRise(low) ? low : high;
            if (canRise(cell)) depth_[cell] += 2, changes = true;
        }
    }
}

// Sheets that lie on each other may have any order: the one that leaves the least volume inside
// out is right.
bool MeshCells::placeAll() {
    std::stable_sort(edges_.begin(), edges_.end(), [](const auto& a, const auto& b) {
        return a.size() - tiesOf(a).size() < b.size() - tiesOf(b).size();
    });
    double volume = 0, least = 1e300;
    for (const Patch& p : patches_) volume += std::abs(p.volume);
    std::mt19937 random(1);
    std::vector<int> ranks(patches_.size()), best;
    std::iota(ranks.begin(), ranks.end(), 0);
    const size_t cells = cells_.steps(), groups = groups_.steps();
    for (int attempt = 0; attempt < MostAttempts && least > 1e-9 * volume; ++attempt) {
        if (attempt > 0) std::shuffle(ranks.begin(), ranks.end(), random);
        if (const double here = place(ranks); here < least) least = here, best = ranks;
        cells_.backTo(cells), groups_.backTo(groups);
    }
    return !best.empty() && place(best) == least;
}

double MeshCells::place(const std::vector<int>& ranks) {
    for (std::vector<Sheet>& sheets : edges_) {
        for (Sheet& s : sheets) s.rank = ranks[size_t(s.patch)];
        if (!place(sheets)) return 1e300;
    }
    return findOutside();
}

bool MeshCells::solve() {
    if (!placeAll()) return false;
    for (const std::vector<Sheet>& sheets : edges_) noteCrossing(sheets);
    findMost();
    for (int s = 0; s < int(depth_.size()); ++s) {
        const int outside = outside_[size_t(groups_.rootOf(s))], cell = cells_.rootOf(s);
        const bool odd = groups_.parityOf(s) != groups_.parityOf(outside);
        depth_[size_t(cell)] = odd ? 1 : cell != outside && isCrossing(cell) ? 2 : 0;
    }
    raise();
    return true;
}

}  // namespace spindrift
