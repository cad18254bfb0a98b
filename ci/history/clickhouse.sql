-- Questions to `etalon history export --format parquet DIR`, for ClickHouse (clickhouse-local or chdb). Run it in DIR: the paths are
-- relative. The columns date and adapter are the names of the folders (use_hive_partitioning, which is on by default). ClickHouse
-- leaves their escapes as they are, so that every statement decodes them. duckdb.sql asks the same.

-- The share of good cases per adapter and night, among the cases that every whole run of the adapter has a verdict of.
with records as (
    select decodeURLComponent(adapter) as adapter, date, run, "case", verdict in ('pass', 'imprecise', 'measured', 'not-supported', 'skipped') as good
    from file('records/**/*.parquet', Parquet)
),
sizes as (select adapter, run, count(*) as n from records group by adapter, run),
longest as (select adapter, max(n) as most from sizes group by adapter),
whole as (select adapter, run from sizes join longest using (adapter) where n >= 0.9 * most),
due as (select adapter, count(*) as runs from whole group by adapter),
seen as (
    select adapter, "case", count(*) as runs from records
    where (adapter, run) in (select adapter, run from whole)
    group by adapter, "case"
),
common as (select seen.adapter as adapter, "case" from seen join due on seen.adapter = due.adapter and seen.runs = due.runs)
select adapter, date, run, count(*) as cases, avg(case when good then 1.0 else 0.0 end) as good
from records
where (adapter, run) in (select adapter, run from whole) and (adapter, "case") in (select adapter, "case" from common)
group by adapter, date, run
order by adapter, date, run;

-- What broke between the last two runs of each adapter: good before, bad now.
with runs as (
    select adapter, run, row_number() over (partition by adapter order by time desc, run) as back
    from (select distinct decodeURLComponent(adapter) as adapter, run, time from file('records/**/*.parquet', Parquet) where kind <> 'bench')
),
records as (
    select decodeURLComponent(adapter) as adapter, run, version, "case", verdict, unexpected,
        verdict in ('pass', 'imprecise', 'measured', 'not-supported', 'skipped') as good
    from file('records/**/*.parquet', Parquet)
    where (adapter, run) in (select adapter, run from runs where back <= 2)
),
now as (select * from records where (adapter, run) in (select adapter, run from runs where back = 1)),
before as (select * from records where (adapter, run) in (select adapter, run from runs where back = 2))
select now.adapter as adapter, now."case" as "case", before.verdict as was, now.verdict as is_now, now.unexpected as unexpected,
    before.version as version_before, now.version as version_now
from now join before on now.adapter = before.adapter and now."case" = before."case"
where before.good and not now.good
order by 1, 2;

-- Which cases are flaky: drawn differently within a run, or good and bad with the same driver and commit.
with records as (
    select decodeURLComponent(adapter) as adapter, version, "commit", "case", verdict,
        verdict in ('pass', 'imprecise', 'measured', 'not-supported', 'skipped') as good
    from file('records/**/*.parquet', Parquet)
),
states as (
    select adapter, "case", version, "commit", count(*) as runs,
        sum(case when verdict = 'flaky' then 1 else 0 end) as flaky,
        case when max(good) and not min(good) then 1 else 0 end as both_ways
    from records
    group by adapter, "case", version, "commit"
)
select adapter, "case", sum(runs) as in_runs, sum(flaky) as flaky_runs, sum(both_ways) as good_and_bad
from states
group by adapter, "case"
having sum(flaky) > 0 or sum(both_ways) > 0
order by flaky_runs desc, good_and_bad desc, adapter, "case"
limit 200;

-- The oldest bad verdicts: bad in the last run of the adapter, and in every run that has the case since that day.
with records as (
    select decodeURLComponent(adapter) as adapter, run, time, date, "case", verdict, unexpected, expectation,
        verdict in ('pass', 'imprecise', 'measured', 'not-supported', 'skipped') as good
    from file('records/**/*.parquet', Parquet)
    where kind <> 'bench'
),
last as (
    select adapter, run, row_number() over (partition by adapter order by time desc, run) as back
    from (select distinct adapter, run, time from records)
),
bad as (
    select adapter, "case", verdict, unexpected, expectation from records
    where not good and (adapter, run) in (select adapter, run from last where back = 1)
),
past as (
    select adapter, "case", max(case when good then time else -1 end) as last_good
    from records
    where (adapter, "case") in (select adapter, "case" from bad)
    group by adapter, "case"
),
since as (
    select records.adapter as adapter, records."case" as "case", min(records.date) as since, count(*) as runs
    from records join past on records.adapter = past.adapter and records."case" = past."case"
    where records.time > past.last_good
    group by records.adapter, records."case"
)
select bad.adapter as adapter, bad."case" as "case", since.since as since, since.runs as runs, bad.verdict as verdict,
    bad.unexpected as unexpected, bad.expectation as expectation
from bad join since on bad.adapter = since.adapter and bad."case" = since."case"
order by since, adapter, "case"
limit 200;

-- What became slower most: medians of the last 10 runs over those of the 10 before, and the same of the ruler.
with times as (
    select decodeURLComponent(adapter) as adapter, machine, "case", wall, ruler,
        row_number() over (partition by adapter, machine, "case" order by time desc, run) as back
    from file('frame_times/**/*.parquet', Parquet)
    where wall is not null
),
medians as (
    select adapter, machine, "case",
        quantileExactInclusiveIf(0.5)(wall, back <= 10) as now,
        quantileExactInclusiveIf(0.5)(wall, back > 10) as before,
        quantileExactInclusiveIf(0.5)(ruler, back <= 10) as ruler_now,
        quantileExactInclusiveIf(0.5)(ruler, back > 10) as ruler_before
    from times
    where back <= 20
    group by adapter, machine, "case"
    having count(*) = 20
)
select adapter, machine, "case", before, now, now / before as change, ruler_now / ruler_before as ruler_change
from medians
order by change desc, adapter, machine, "case"
limit 50;

-- Cases of which adapters disagree: good on some, bad on others, each in its last run.
with runs as (
    select adapter, run, row_number() over (partition by adapter order by time desc, run) as back
    from (select distinct decodeURLComponent(adapter) as adapter, run, time from file('records/**/*.parquet', Parquet) where kind <> 'bench')
),
records as (
    select decodeURLComponent(adapter) as adapter, "case", verdict, verdict in ('pass', 'imprecise', 'measured') as good,
        verdict in ('not-supported', 'skipped') as not_drawn
    from file('records/**/*.parquet', Parquet)
    where (adapter, run) in (select adapter, run from runs where back = 1)
)
select "case", sum(case when good then 1 else 0 end) as good_on, sum(case when good then 0 else 1 end) as bad_on,
    arrayStringConcat(arraySort(groupArrayIf(adapter || ' ' || verdict, not good)), ', ') as bad
from records
where not not_drawn
group by "case"
having max(good) and not min(good)
order by bad_on desc, "case"
limit 200;
