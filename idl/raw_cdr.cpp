// Samples as bytes. The only file that includes Cyclone's internal headers: they are shipped, but
// other versions call things otherwise.
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

#include <array>
#include <cstring>

#include "core/signal/saturated.hpp"
#include "idl/cdr.hpp"
#include "idl/raw_reader.hpp"
#include "idl/raw_writer.hpp"
#include "mpm.h"

namespace mpm::idl {
namespace {

constexpr std::size_t kBatch = 256;
constexpr std::uint32_t kDisposeFlag = 1, kUnregisterFlag = 2;  // of a serdata's statusinfo

void copy(const ddsi_serdata* data, std::vector<std::byte>& bytes) {
  bytes.resize(ddsi_serdata_size(data));
  ddsi_serdata_to_ser(data, 0, bytes.size(), bytes.data());
}

/// Counted reference to what Cyclone knows of a topic's type. No public call gives it; a sample
/// that was written and taken has it. The pair that does so lives in a partition of its own, so
/// nobody else sees that sample.
class SerType {
 public:
  SerType(const Participant& participant, dds_entity_t topic, const KnownTopic& known) {
    const Qos partition(dds_create_qos());
    dds_qset_partition1(partition.get(), "mpm-type-of-topic");
    const std::string what = std::string("type of ") + known.name;
    const Entity publisher(dds_create_publisher(participant.get(), partition.get(), nullptr), what);
    const Entity subscriber(dds_create_subscriber(participant.get(), partition.get(), nullptr),
                            what);
    const Entity reader(dds_create_reader(subscriber.get(), topic, nullptr, nullptr), what);
    const Entity writer(dds_create_writer(publisher.get(), topic, nullptr, nullptr), what);
    const std::vector<std::byte> nothing(known.type->m_size);
    check(dds_write(writer.get(), nothing.data()), what);
    ddsi_serdata* data = nullptr;
    dds_sample_info_t info;
    if (check(dds_takecdr(reader.get(), &data, 1, &info, DDS_ANY_STATE), what) != 1)
      throw Error("DDS: " + what + ": not found");
    type_ = ddsi_sertype_ref(data->type);
    ddsi_serdata_unref(data);
  }
  SerType(const SerType&) = delete;
  SerType& operator=(const SerType&) = delete;
  ~SerType() { ddsi_sertype_unref(const_cast<ddsi_sertype*>(type_)); }

  [[nodiscard]] const ddsi_sertype* get() const { return type_; }

 private:
  const ddsi_sertype* type_ = nullptr;
};

/// A decoded sample, as far as this file knows its type.
class Decoded {
 public:
  Decoded(const dds_topic_descriptor_t& type, const ddsi_serdata* data)
      : type_(type), memory_(dds_alloc(type.m_size)) {
    std::memset(memory_, 0, type.m_size);
    ddsi_serdata_to_sample(data, memory_, nullptr, nullptr);
  }
  Decoded(const Decoded&) = delete;
  Decoded& operator=(const Decoded&) = delete;
  ~Decoded() { dds_sample_free(memory_, &type_, DDS_FREE_ALL); }

  void change(const SampleChange& change) {
    if (!change.unit.empty()) {
      auto** unit = static_cast<char**>(memory_);  // the first member, see topic_catalog.hpp
      dds_string_free(*unit);
      *unit = dds_string_dup(change.unit.c_str());
    }
    if (&type_ != &mpm_Sample_desc) return;
    auto* sample = static_cast<mpm_Sample*>(memory_);
    sample->interval = saturated_sum(sample->interval, change.add_intervals);
    sample->source_time_ns = saturated_sum(sample->source_time_ns, change.add_time_ns);
  }
  [[nodiscard]] const void* get() const { return memory_; }

 private:
  const dds_topic_descriptor_t& type_;
  void* memory_;
};

}  // namespace

RawReader::RawReader(const Participant& participant, const KnownTopic& topic, UnitChoice* units)
    : RawReader(participant, topic.name, *topic.type, topic.reader_qos(), topic.type->m_nkeys,
                units) {}

RawReader::RawReader(const Participant& participant, const std::string& topic,
                     const DiscoveredType& type)
    : RawReader(participant, topic, *type, foreign_reader_qos(), 0, nullptr) {}

RawReader::RawReader(const Participant& participant, const std::string& topic,
                     const dds_topic_descriptor_t& type, const Qos& qos, std::size_t names,
                     UnitChoice* units)
    : name_(topic),
      type_name_(type.m_typename),
      keys_(std::make_unique<KeyLimit>(names, units)),
      topic_(topic_with(*keys_, participant, type, topic)),
      reader_(dds_create_reader(participant.get(), topic_.get(), qos.get(), nullptr),
              "reader of " + topic),
      readable_(dds_create_readcondition(reader_.get(), DDS_ANY_STATE), "read condition") {}

int RawReader::take(const std::function<void(RawSample&)>& on_sample) {
  std::array<ddsi_serdata*, kBatch> data{};
  std::array<dds_sample_info_t, kBatch> infos;
  const dds_return_t count =
      dds_takecdr(reader_.get(), data.data(), kBatch, infos.data(), DDS_ANY_STATE);
  for (std::size_t i = 0; static_cast<dds_return_t>(i) < count; ++i) {
    const SampleInfo info = info_of(infos[i]);
    const auto pass_on = [&](const ddsi_serdata* bytes, bool valid) {
      // Of an end nobody is asked whether it is to be taken.
      if (!valid && ddsi_serdata_size(bytes) > keys_->longest_key()) return;
      copy(bytes, sample_.cdr);
      sample_.source_time_ns = info.source_time_ns;
      sample_.state = valid ? InstanceState::kAlive : info.state;
      sample_.valid = valid;
      sample_.writer = info.writer;
      on_sample(sample_);
    };
    pass_on(data[i], info.valid);
    // An end that came while data was waiting shows in the data's state only. Where the batch is
    // full more data of the instance may follow, and its last sample will show the same.
    const bool last = infos[i].sample_rank == 0 && (i + 1 < kBatch);
    if (info.valid && last && info.state != InstanceState::kAlive) {
      ddsi_serdata* key = ddsi_serdata_to_untyped(data[i]);
      pass_on(key, false);
      ddsi_serdata_unref(key);
    }
    ddsi_serdata_unref(data[i]);
  }
  keys_->make_room(reader_.get());
  return std::max(count, 0);
}

std::uint64_t RawReader::lost() const {
  dds_sample_lost_status_t status{};
  check(dds_get_sample_lost_status(reader_.get(), &status), "lost samples");
  return status.total_count;
}

int RawReader::matched_writers() const {
  dds_subscription_matched_status_t status{};
  check(dds_get_subscription_matched_status(reader_.get(), &status), "matched writers");
  return static_cast<int>(status.current_count);
}

struct RawWriter::Impl {
  Impl(const Participant& participant, const KnownTopic& known_topic, WriterPace pace)
      : known(known_topic),
        topic(dds_create_topic(participant.get(), known.type, known.name, nullptr, nullptr),
              std::string("topic ") + known.name),
        type(participant, topic.get(), known),
        writer(dds_create_writer(participant.get(), topic.get(), known.writer_qos(pace).get(),
                                 nullptr),
               std::string("writer of ") + known.name),
        reader(known.type),
        read(known.type->m_size) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() { reader.release(read.data()); }

  /// Owned by the caller; null if the bytes are no sample.
  [[nodiscard]] ddsi_serdata* data_of(std::span<const std::byte> cdr, ddsi_serdata_kind kind,
                                      const SampleChange& change) {
    // Cyclone's own check is not enough (Cdr::decode).
    if (kind == SDK_DATA && !reader.decode(cdr, read.data())) return nullptr;
    const ddsrt_iovec_t bytes{const_cast<std::byte*>(cdr.data()), cdr.size()};
    ddsi_serdata* data = ddsi_serdata_from_ser_iov(type.get(), kind, 1, &bytes, cdr.size());
    if (data == nullptr || !change.any()) return data;
    Decoded sample(*known.type, data);
    ddsi_serdata_unref(data);
    sample.change(change);
    return ddsi_serdata_from_sample(type.get(), kind, sample.get());
  }
  [[nodiscard]] WriteResult forward(ddsi_serdata* data, std::uint32_t status,
                                    std::int64_t source_time_ns) const {
    if (data == nullptr) return WriteResult::kNotCdr;
    data->timestamp.v = source_time_ns;
    data->statusinfo = status;
    return dds_forwardcdr(writer.get(), data) == DDS_RETCODE_OK ? WriteResult::kWritten
                                                                : WriteResult::kTimeout;
  }

  const KnownTopic& known;
  Entity topic;
  SerType type;
  Entity writer;
  Cdr reader;
  std::vector<std::byte> read;  // by it
};

RawWriter::RawWriter(const Participant& participant, const KnownTopic& topic, WriterPace pace)
    : impl_(std::make_unique<Impl>(participant, topic, pace)) {}
RawWriter::RawWriter(RawWriter&&) noexcept = default;
RawWriter& RawWriter::operator=(RawWriter&&) noexcept = default;
RawWriter::~RawWriter() = default;

WriteResult RawWriter::write(std::span<const std::byte> cdr, std::int64_t source_time_ns,
                             const SampleChange& change) const {
  return impl_->forward(impl_->data_of(cdr, SDK_DATA, change), 0, source_time_ns);
}

WriteResult RawWriter::end_instance(std::span<const std::byte> key, InstanceState state,
                                    std::int64_t source_time_ns, const SampleChange& change) const {
  return impl_->forward(impl_->data_of(key, SDK_KEY, change),
                        state == InstanceState::kDisposed ? kDisposeFlag : kUnregisterFlag,
                        source_time_ns);
}

int RawWriter::matched_readers() const {
  dds_publication_matched_status_t status{};
  check(dds_get_publication_matched_status(impl_->writer.get(), &status), "matched readers");
  return static_cast<int>(status.current_count);
}

bool RawWriter::greet(std::chrono::nanoseconds timeout) const {
  const std::vector<std::byte> nobody(impl_->known.type->m_size);
  dds_dispose(impl_->writer.get(), nobody.data());
  return flush(timeout);
}

bool RawWriter::flush(std::chrono::nanoseconds timeout) const {
  return dds_wait_for_acks(impl_->writer.get(), timeout.count()) == DDS_RETCODE_OK;
}

}  // namespace mpm::idl
