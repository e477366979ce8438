#pragma once
// Where several sheets of triangles meet in an edge: which of them enclose solids, and how many.
#include <array>
#include <cstddef>
#include <vector>

namespace spindrift {

// A surface of triangles that hang together by edges of two, all turned to the same side.
struct Patch {
    int times = 1;      // that each of its triangles is there
    double volume = 0;  // between a point that all patches have in common and it
};

// One that ends at an edge.
struct Sheet {
    int patch;
    bool upward;   // whether its triangle goes the way of the edge
    double angle;  // about the edge
    double doubt;  // how wrong that may be
    int rank = 0;  // of its patch among those on which it lies
};

// The space between the sheets falls into cells, each of which lies in a number of solids. On both
// sides of a sheet that is there `times` times are together at least as many, and the numbers
// differ by no more. Of the numbers that fit it takes the least, 0 outside.
class MeshCells {
public:
    explicit MeshCells(std::vector<Patch> patches);
    // The sheets around an edge.
    void meet(std::vector<Sheet> sheets);
    // False if no numbers fit.
    bool solve();
    // By how many more solids there are behind a patch than before it.
    int jump(int patch) const { return depthAt(patch, 0) - depthAt(patch, 1); }
    // The same of patches that hang together.
    int groupOf(int patch) const { return groups_.rootOf(2 * patch); }

private:
    // Sets that grow together, with what is even or odd between their members; the last steps can
    // be taken back.
    class Sets {
    public:
        explicit Sets(size_t count);
        int rootOf(int a) const;
        bool parityOf(int a) const;
        bool join(int a, int b, bool odd);  // false: they are together in the other way
        size_t steps() const { return steps_.size(); }
        void backTo(size_t steps);

    private:
        std::vector<int> parents_, sizes_, steps_;
        std::vector<char> odd_;
    };

    bool placeAll();
    double place(const std::vector<int>& ranks);
    bool place(std::vector<Sheet>& sheets);
    bool tryOrder(const std::vector<Sheet>& sheets);
    void noteCrossing(const std::vector<Sheet>& sheets);
    double findOutside();  // the volume of cells that are inside out, which should be 0
    void findMost();
    bool isCrossing(int cell) const;
    void raise();
    int cellOf(int patch, int side) const { return cells_.rootOf(2 * patch + side); }
    int depthAt(int patch, int side) const { return depth_[size_t(cellOf(patch, side))]; }

    std::vector<Patch> patches_;
    std::vector<std::vector<Sheet>> edges_;
    Sets cells_, groups_;               // of sides: behind (0) and before (1) each patch
    std::vector<int> outside_;          // of each group
    std::vector<int> depth_, most_;     // of each cell
    std::vector<int> straight_, bent_;  // edges of each cell where sheets cross, and others
};

}  // namespace spindrift
