// Slots: values under ids that are never reused. A slot has an index, which later values take again, and a generation,
// which each removal raises.
#pragma once

#include "voile/result.hpp"

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
        uint32_t index = 0;
        while (index < slots_.size() && slots_[index].value)
            ++index;
        return add_at(index, std::move(value));
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
    }

    // One past the highest index in use so far; at(index) is null for a free slot.
    [[nodiscard]] uint32_t end() const { return static_cast<uint32_t>(slots_.size()); }
    [[nodiscard]] Value* at(uint32_t index) { return slots_[index].value ? &*slots_[index].value : nullptr; }
    [[nodiscard]] const Value* at(uint32_t index) const
    {
        return slots_[index].value ? &*slots_[index].value : nullptr;
    }
    [[nodiscard]] Id id_at(uint32_t index) const { return Id{index, slots_[index].generation}; }

private:
    struct Slot
    {
        uint32_t generation = 0;
        std::optional<Value> value;
    };

    Id add_at(uint32_t index, Value value)
    {
        if (index == slots_.size())
            slots_.emplace_back();
        slots_[index].value = std::move(value);
        return id_at(index);
    }

    std::vector<Slot> slots_;
};

} // namespace voile
