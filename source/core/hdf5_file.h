#pragma once
// What all HDF5 files of the program share: handles that close themselves, arrays with checksums
// and units, no time of day.
#include <hdf5.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace spindrift::hdf5 {

// What went wrong with HDF5, without the place: the public functions of a file's reader or writer
// add it.
struct Trouble {
    std::string what;
};

// Owns an HDF5 identifier.
class Handle {
public:
    Handle(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
        if (id < 0) throw Trouble{what};
    }
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    operator hid_t() const { return id_; }
    // Closing a file writes to it: the one place where it matters whether that worked.
    void close(const std::string& what) {
        if (close_(std::exchange(id_, -1)) < 0) throw Trouble{what};
    }

private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};
void require(herr_t result, const std::string& what);

// Makes a file; false when not all of it was written.
bool writeFile(const std::string& path, const std::function<void(hid_t file)>& write);
// Opens a file to read. Throws Trouble.
Handle openFile(const std::string& path);

// Whether a file claims to be HDF5.
bool isFile(const std::string& path);

// A dataset of this size, stored as one type from another in memory.
void writeArray(hid_t file, const std::string& name, hid_t stored, hid_t native, const void* data,
                const std::vector<hsize_t>& size);
// Text as the attribute "unit" of a dataset; none when it is empty.
void writeUnit(hid_t file, const std::string& name, const std::string& unit);
// That text, of fixed or variable length; empty where there is none.
std::string readUnit(hid_t file, const std::string& name);
// Text as an attribute of the file; none when it is empty.
void writeText(hid_t file, const std::string& name, const std::string& text);
std::string readText(hid_t file, const std::string& name);
// A dataset of one dimension, float64.
void writeNumbers(hid_t file, const std::string& name, const std::string& unit,
                  const std::vector<double>& values);

// An opened dataset of `rank` dimensions and its size.
struct Array {
    Handle set;
    std::vector<hsize_t> size;
    Array(hid_t file, const std::string& name, int rank);
};
std::vector<double> readNumbers(hid_t file, const std::string& name);
// Of all that the file holds at its top.
std::vector<std::string> names(hid_t file);

}  // namespace spindrift::hdf5
