// Slots: values under ids that are never reused. A slot has an index, which later values take again, and a generation,
// which each removal raises.
#pragma once

#include "voile/result.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace voile
{

// Id: a struct of index and generation, both uint32_t; a default-constructed one names no slot.
template <typename Id, typename Value>
class Slots
{
public:
    // The lowest free index is used first.
    Id add(Value value)
    {
        while (lowest_free_ < size() && slots_[lowest_free_].value)
            ++lowest_free_;
        if (lowest_free_ == size())
            slots_.emplace_back();
        slots_[lowest_free_].value.emplace(std::move(value));
        return id_at(lowest_free_);
    }

    // Null for an id that names nothing: default-constructed, never given, or of a value that was removed.
    [[nodiscard]] Value* find(Id id) { return has(id) ? &*slots_[id.index].value : nullptr; }
    [[nodiscard]] const Value* find(Id id) const { return has(id) ? &*slots_[id.index].value : nullptr; }
    [[nodiscard]] bool has(Id id) const
    {
        return id.index < slots_.size() && slots_[id.index].value && slots_[id.index].generation == id.generation;
    }

    // Errors: an id that names nothing. `what` is "cloth", "collider" or "anchor".
    [[nodiscard]] Result<void> check(const char* what, Id id) const
    {
        if (has(id))
            return {};
        if (id == Id{})
            return Error{std::string(what) + ": the id is a default-constructed one"};
        const std::string subject = std::string(what) + " " + std::to_string(id.index);
        if (id.index < slots_.size() && id.generation < slots_[id.index].generation)
            return Error{subject + " was removed"};
        return Error{subject + " does not exist"};
    }

    // Requires has(id).
    void remove(Id id)
    {
        slots_[id.index].value.reset();
        ++slots_[id.index].generation;
        lowest_free_ = std::min(lowest_free_, id.index);
    }

    // Slots in use or free: one past the highest index so far.
    [[nodiscard]] uint32_t size() const { return static_cast<uint32_t>(slots_.size()); }
    // Null for a free slot.
    [[nodiscard]] Value* at(uint32_t index)
    {
        return index < size() && slots_[index].value ? &*slots_[index].value : nullptr;
    }
    [[nodiscard]] const Value* at(uint32_t index) const
    {
        return index < size() && slots_[index].value ? &*slots_[index].value : nullptr;
    }
    [[nodiscard]] Id id_at(uint32_t index) const { return Id{index, slots_[index].generation}; }

    // Iteration visits the slots in use: for (auto [index, value] : slots).
    [[nodiscard]] auto begin() { return Iterator<Slots, Value>(*this, 0); }
    [[nodiscard]] auto end() { return Iterator<Slots, Value>(*this, size()); }
    [[nodiscard]] auto begin() const { return Iterator<const Slots, const Value>(*this, 0); }
    [[nodiscard]] auto end() const { return Iterator<const Slots, const Value>(*this, size()); }

private:
    template <typename Owner, typename Element>
    class Iterator
    {
    public:
        struct Item
        {
            uint32_t index;
            Element& value;
        };

        Iterator(Owner& slots, uint32_t index) : slots_(&slots), index_(index) { skip_free(); }
        Item operator*() const { return {index_, *slots_->at(index_)}; }
        Iterator& operator++()
        {
            ++index_;
            skip_free();
            return *this;
        }
        bool operator==(const Iterator& other) const { return index_ == other.index_; }

    private:
        void skip_free()
        {
            while (index_ < slots_->size() && slots_->at(index_) == nullptr)
                ++index_;
        }

        Owner* slots_;
        uint32_t index_;
    };

    struct Slot
    {
        uint32_t generation = 0;
        std::optional<Value> value;
    };

    std::vector<Slot> slots_;
    uint32_t lowest_free_ = 0; // no slot below it is free
};

} // namespace voile
