// The folder that is the whole state of a job.

#include <umov/scale/job_folder.h>
#include <umov/scale/lease.h>
#include <umov/scale/plan.h>
#include <umov/scale/status.h>

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace umov::scale {
namespace {

namespace fs = std::filesystem;

JobLock a_job() {
  JobLock out;
  out.verb = "signature";
  out.arguments = {"s.toml", "--poses", "100"};
  out.directory = "/somewhere";
  out.identity = "umov 1\ninput a\nseed 1\n";
  out.unit = "poses";
  out.total = 100;
  out.per_shard = 30;
  out.layout = {60, 40};
  out.tables = {"signature"};
  out.nothing = "no pose in this span";
  out.problems = "problem";
  out.warnings = {"elements are old"};
  out.tallies = {{"frame", "cut", ""}, {"", "rows are full", "all are full"}};
  return out;
}

class JobFolders : public ::testing::Test {
protected:
  void SetUp() override {
    path = fs::path(::testing::TempDir()) /
           ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(path);
  }
  fs::path path;
};

TEST_F(JobFolders, CutAJobIntoRangesThatCoverIt) {
  const JobLock job = a_job();
  ASSERT_EQ(job.shards(), 4u);
  std::size_t next = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(job.range(k).first, next);
    next = job.range(k).end();
  }
  EXPECT_EQ(next, 100u);
}

TEST_F(JobFolders, KeepTheirJob) {
  ASSERT_TRUE(JobFolder::begin(path, a_job()));
  const auto again = JobFolder::open(path);
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(to_json(again->lock()), to_json(a_job()));
  EXPECT_TRUE(JobFolder::begin(path, a_job())); // the same job goes on
}

TEST_F(JobFolders, ReadJobsThatWereBegunBeforeTheyHadWarnings) {
  std::string text = to_json(a_job());
  for (const char *key : {"warnings", "tallies"}) {
    const std::size_t at = text.find(std::string("\"") + key + "\"");
    ASSERT_NE(at, std::string::npos);
    text.replace(at + 1, 1, "x"); // a key that nobody asks for
  }
  const auto read = lock_from_json(text, "job.json");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_TRUE(read->warnings.empty() && read->tallies.empty());
  EXPECT_EQ(read->key(), a_job().key()); // what the rows are named after is the same
}

TEST_F(JobFolders, HaveNoLayoutOfPartsOrOfMoreThanCanBeCounted) {
  for (const char *bad : {"0.5", "-1", "1e300", "18446744073709551616"}) {
    std::string text = to_json(a_job());
    const std::size_t at = text.find("60", text.find("\"layout\""));
    ASSERT_NE(at, std::string::npos);
    text.replace(at, 2, bad);
    const auto read = lock_from_json(text, "job.json");
    ASSERT_FALSE(read) << bad;
    EXPECT_NE(read.error().message.find("layout is no whole number"), std::string::npos)
        << read.error().message;
  }
}

TEST_F(JobFolders, HaveListsOfPartsAndTallies) {
  for (const std::string key : {"layout", "tallies"})
    for (const char *bad : {"null", "{}", R"({"a": 60, "b": 40})", "60", "\"60\""}) {
      std::string text = to_json(a_job());
      const std::size_t at = text.find('[', text.find('"' + key + '"'));
      ASSERT_NE(at, std::string::npos);
      text.replace(at, text.find(']', at) + 1 - at, bad);
      const auto read = lock_from_json(text, "job.json");
      ASSERT_FALSE(read) << key << " " << bad;
      EXPECT_NE(read.error().message.find(key + " is no list"), std::string::npos)
          << read.error().message;
    }
}

TEST_F(JobFolders, OfAnotherJobAreRefusedWithTheLineThatDiffers) {
  ASSERT_TRUE(JobFolder::begin(path, a_job()));
  JobLock other = a_job();
  other.identity = "umov 1\ninput a\nseed 2\n";
  const auto refused = JobFolder::begin(path, other);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::BadInput);
  EXPECT_NE(refused.error().message.find("was \"seed 1\", is \"seed 2\""), std::string::npos)
      << refused.error().message;
}

TEST_F(JobFolders, WithSomethingElseInThemAreRefused) {
  fs::create_directories(path);
  std::ofstream(path / "thesis.tex") << "\n";
  EXPECT_FALSE(JobFolder::begin(path, a_job()));
  EXPECT_FALSE(fs::exists(path / "job.json"));
}

TEST_F(JobFolders, SayHowFarTheyAre) {
  const auto folder = JobFolder::begin(path, a_job());
  ASSERT_TRUE(folder);
  const Shard first = folder->named(0, std::string(64, 'a'));
  fs::create_directories(folder->file_of(first).parent_path());
  std::ofstream(folder->file_of(first)) << "12345";
  FailedShard failed;
  failed.index = 2, failed.code = 5, failed.message = "not physical", failed.attempts = 3;
  folder->tell_failed(failed);
  const auto status = status_of(*folder);
  ASSERT_TRUE(status) << status.error().text();
  EXPECT_EQ(status->done, 1u);
  EXPECT_EQ(status->shards, 4u);
  EXPECT_EQ(status->bytes, 5u);
  ASSERT_EQ(status->failed.size(), 1u);
  const std::string text = describe(*status);
  EXPECT_NE(text.find("1 of 4 shards are done (100 poses in all)"), std::string::npos) << text;
  EXPECT_NE(text.find("shard 2 failed (5, tried 3 times): not physical"), std::string::npos);
  EXPECT_NE(text.find("nobody is at work"), std::string::npos);
  EXPECT_NE(to_json(*status).find("\"is_complete\": false, \"is_held\": false"), std::string::npos);
}

TEST_F(JobFolders, ChangedByHandAreRefused) {
  std::string text = to_json(a_job());
  text.replace(text.find("\"total\": 100"), 12, "\"total\": 200");
  const auto read = lock_from_json(text, "job.json");
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("changed by hand"), std::string::npos);
}

TEST_F(JobFolders, ListShardsOfTheirKeyAlone) {
  const auto folder = JobFolder::begin(path, a_job());
  ASSERT_TRUE(folder);
  const Shard mine = folder->named(2, std::string(64, 'a'));
  std::ofstream(folder->file_of(mine)) << "x";
  std::ofstream(path / "shards" /
                "00000001-ffffffffffffffff-aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa.rows");
  std::ofstream(path / "shards" / "notes.txt");
  const auto there = folder->shards();
  ASSERT_TRUE(there);
  ASSERT_EQ(there->size(), 1u);
  EXPECT_EQ(there->begin()->first, 2u);
  EXPECT_EQ(folder->find(2)->name, mine.name);
  EXPECT_FALSE(folder->find(1));
}

TEST_F(JobFolders, OfManyShardsListThoseThatStandInTheirPlace) {
  JobLock job = a_job();
  job.total = 20'000;
  job.per_shard = 1;
  const auto folder = JobFolder::begin(path, job);
  ASSERT_TRUE(folder);
  const Shard mine = folder->named(12'345, std::string(64, 'a'));
  EXPECT_EQ(folder->file_of(mine).parent_path().filename(), "00012");
  const fs::path shards = path / "shards";
  fs::create_directories(shards / "00011");
  fs::create_directories(shards / "copies");
  for (const fs::path &place : {folder->file_of(mine), shards / mine.name,
                                shards / "00011" / mine.name, shards / "copies" / mine.name})
    std::ofstream(place) << "x";
  const auto there = folder->shards();
  ASSERT_TRUE(there);
  ASSERT_EQ(there->size(), 1u);
  EXPECT_EQ(there->at(12'345).size(), 1u);
}

TEST_F(JobFolders, TellOfFailuresUntilTheyAreForgotten) {
  const auto folder = JobFolder::begin(path, a_job());
  ASSERT_TRUE(folder);
  folder->tell_failed({3, 139, 3, "its process was ended", "here"});
  ASSERT_EQ(folder->failed().size(), 1u);
  EXPECT_EQ(folder->failed()[0].code, 139);
  folder->forget_failed(3);
  EXPECT_TRUE(folder->failed().empty());
}

TEST_F(JobFolders, AreHeldByOneAtATime) {
  fs::create_directories(path);
  {
    const auto lease = Lease::take(path, "");
    ASSERT_TRUE(lease);
    EXPECT_FALSE(Lease::take(path, ""));
    EXPECT_FALSE(Lease::take(path, "0-of-2"));
    EXPECT_NE(lease_holders(path), "");
  }
  EXPECT_EQ(lease_holders(path), "");
  const auto one = Lease::take(path, "0-of-2"), other = Lease::take(path, "1-of-2");
  EXPECT_TRUE(one && other); // parts do not meet
  EXPECT_FALSE(Lease::take(path, ""));
}

TEST_F(JobFolders, OfAMillionShardsArePlannedAtOnce) {
  JobLock job = a_job();
  job.total = 1'000'000'000'000;
  job.per_shard = 1'000'000;
  job.rate = {1e-6, 36, 10};
  const Plan plan = plan_of(job, {1000, 10, 0});
  EXPECT_EQ(plan.shards, 1'000'000u);
  EXPECT_NEAR(plan.core_hours, (1e6 + 100 * 10) / 3600, 1e-6); // a hundred processes begin
  EXPECT_NEAR(plan.gigabytes, 36'000, 1e-6);
}

TEST(JobFolder, NumbersOfJsonThatAreNoWholeOnesAreNone) {
  const FailedShard failed{3, 139, 2, "ended", "a"};
  const std::string text = to_json(failed, {30, 10});
  const auto back = failed_from_json(text);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->index, 3u);
  EXPECT_EQ(back->code, 139);
  EXPECT_EQ(back->attempts, 2u);
  for (const char *number : {"1e300", "-3", "3.5", "\"3\"", "null"}) {
    std::string bad = text;
    bad.replace(bad.find("3,"), 1, number); // the index
    EXPECT_FALSE(failed_from_json(bad)) << bad;
  }
  EXPECT_FALSE(failed_from_json("[]"));
}

} // namespace
} // namespace umov::scale
