#include "core/hdf5_file.h"

#include <algorithm>
#include <fstream>
#include <mutex>

namespace spindrift::hdf5 {
namespace {

// More rows than any run has: a damaged size must not ask for memory.
constexpr hsize_t MostRows = 1'000'000'000;

// HDF5 writes its errors to standard error by default, and tidies up when the program ends, where
// it was seen to crash after reading a damaged file; all that is open here is closed here.
void prepareLibrary() {
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

// Without the time of day: the same state gives the same file.
Handle timelessOptions(hid_t kind, const std::string& what) {
    const hid_t options = H5Pcreate(kind);
    H5Pset_obj_track_times(options, false);
    return Handle(options, H5Pclose, what);
}

}  // namespace

void require(herr_t result, const std::string& what) {
    if (result < 0) throw Trouble{what};
}

bool writeFile(const std::string& path, const std::function<void(hid_t file)>& write) {
    // The library of most systems can't be used by two threads at once, and series of particles
    // are written beside the run.
    static std::mutex oneAtATime;
    const std::lock_guard lock(oneAtATime);
    prepareLibrary();
    try {
        Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "access");
        // The newest layout has checksums over everything that isn't data.
        require(H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST), "version");
        const Handle options = timelessOptions(H5P_FILE_CREATE, "options");
        Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, options, access), H5Fclose, "create");
        write(file);
        file.close("close");
        return true;
    } catch (const Trouble&) { return false; }
}

Handle openFile(const std::string& path) {
    prepareLibrary();
    return Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "the file");
}

bool isFile(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    char start[4] = {};
    stream.read(start, sizeof start);
    return std::string(start, sizeof start) == "\x89HDF";
}

// In chunks with checksums; HDF5 has no chunks of nothing.
void writeArray(hid_t file, const std::string& name, hid_t stored, hid_t native, const void* data,
                const std::vector<hsize_t>& size) {
    std::vector<hsize_t> chunk = size;
    chunk[0] = std::min<hsize_t>(size[0], 1 << 16);
    Handle space(H5Screate_simple(int(size.size()), size.data(), nullptr), H5Sclose, name);
    const Handle options = timelessOptions(H5P_DATASET_CREATE, name);
    if (size[0] > 0) {
        require(H5Pset_chunk(options, int(size.size()), chunk.data()), name);
        require(H5Pset_fletcher32(options), name);
    }
    Handle set(H5Dcreate2(file, name.c_str(), stored, space, H5P_DEFAULT, options, H5P_DEFAULT),
               H5Dclose, name);
    if (size[0] > 0) require(H5Dwrite(set, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), name);
}

namespace {

// Text as an attribute of a file or a dataset; none when it is empty.
void writeAttribute(hid_t of, const std::string& name, const std::string& text) {
    if (text.empty()) return;
    Handle space(H5Screate(H5S_SCALAR), H5Sclose, name);
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose, name);
    require(H5Tset_size(type, text.size()), name);
    require(H5Tset_cset(type, H5T_CSET_UTF8), name);
    const hid_t made = H5Acreate2(of, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT);
    Handle attribute(made, H5Aclose, name);
    require(H5Awrite(attribute, type, text.data()), name);
}

// Of fixed or variable length; empty where there is none. `what` is what can't be read.
std::string readAttribute(hid_t of, const std::string& name, const std::string& what) {
    if (H5Aexists(of, name.c_str()) <= 0) return "";
    Handle attribute(H5Aopen(of, name.c_str(), H5P_DEFAULT), H5Aclose, what);
    Handle type(H5Aget_type(attribute), H5Tclose, what);
    Handle space(H5Aget_space(attribute), H5Sclose, what);
    if (H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1)
        throw Trouble{what};
    if (H5Tis_variable_str(type) <= 0) {
        std::string text(H5Tget_size(type), 0);
        require(H5Aread(attribute, type, text.data()), what);
        return text.c_str();  // padded with zeros
    }
    char* text = nullptr;
    require(H5Aread(attribute, type, &text), what);
    const std::string read = text ? text : "";
    H5free_memory(text);
    return read;
}

}  // namespace

void writeUnit(hid_t file, const std::string& name, const std::string& unit) {
    Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, name);
    writeAttribute(set, "unit", unit);
}

std::string readUnit(hid_t file, const std::string& name) {
    Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, name);
    return readAttribute(set, "unit", name + "'s unit");
}

void writeText(hid_t file, const std::string& name, const std::string& text) {
    writeAttribute(file, name, text);
}
std::string readText(hid_t file, const std::string& name) {
    return readAttribute(file, name, name);
}

void writeNumbers(hid_t file, const std::string& name, const std::string& unit,
                  const std::vector<double>& values) {
    writeArray(file, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.data(), {values.size()});
    writeUnit(file, name, unit);
}

Array::Array(hid_t file, const std::string& name, int rank)
    : set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, name), size(size_t(rank)) {
    Handle space(H5Dget_space(set), H5Sclose, name);
    if (H5Sget_simple_extent_ndims(space) != rank) throw Trouble{name};
    H5Sget_simple_extent_dims(space, size.data(), nullptr);
    if (size[0] > MostRows) throw Trouble{name};
}

std::vector<double> readNumbers(hid_t file, const std::string& name) {
    const Array array(file, name, 1);
    std::vector<double> values(array.size[0]);
    if (!values.empty())
        require(H5Dread(array.set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
                name);
    return values;
}

std::vector<std::string> names(hid_t file) {
    std::vector<std::string> all;
    const auto note = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
        static_cast<std::vector<std::string>*>(list)->push_back(name);
        return 0;
    };
    require(H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, note, &all), "names");
    return all;
}

}  // namespace spindrift::hdf5
