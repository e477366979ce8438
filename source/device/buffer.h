#pragma once
// Memory of one device. Grows, never shrinks; growing does not keep the contents.
#include <cstddef>
#include <utility>

namespace spindrift {

template <class T, class Device> class Buffer {
public:
    explicit Buffer(Device& device) : device_(&device) {}
    ~Buffer() { device_->release(data_); }
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;

    void resize(size_t n) {
        if (n > capacity_) {
            device_->release(data_);
            data_ = nullptr;
            capacity_ = 0;
            data_ = device_->template allocate<T>(n);
            capacity_ = n;
        }
        size_ = n;
    }
    T* data() const { return data_; }
    size_t size() const { return size_; }
    size_t bytes() const { return capacity_ * sizeof(T); }
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
