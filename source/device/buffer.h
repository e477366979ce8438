#pragma once
// Memory of one device. Grows, never shrinks; growing does not keep the contents. Only the host's
// is zeroed when it is new.
#include <cstddef>
#include <utility>
#include <vector>

namespace spindrift {

template <class T, class Device> class Buffer {
public:
    explicit Buffer(Device& device) : device_(&device) {}
    ~Buffer() { release(); }
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;

    void resize(size_t n) {
        if (n > capacity_) {
            release();
            data_ = device_->template allocate<T>(n);
            capacity_ = n;
        }
        size_ = n;
    }
    void release() {
        device_->release(data_, capacity_ * sizeof(T));
        data_ = nullptr;
        size_ = capacity_ = 0;
    }
    // With what the host has; and back.
    void fill(const std::vector<T>& host) {
        resize(host.size());
        device_->upload(data_, host.data(), host.size());
    }
    std::vector<T> download() const {
        std::vector<T> host(size_);
        device_->download(host.data(), data_, size_);
        return host;
    }
    // There once the device has been waited for.
    std::vector<T> fetch() const {
        std::vector<T> host(size_);
        device_->fetch(host.data(), data_, size_);
        return host;
    }
    T* data() const { return data_; }
    size_t size() const { return size_; }
    void swap(Buffer& o) {
        std::swap(data_, o.data_);
        std::swap(size_, o.size_);
        std::swap(capacity_, o.capacity_);
    }

private:
    Device* device_;
    T* data_ = nullptr;
    size_t size_ = 0, capacity_ = 0;
};

}  // namespace spindrift
