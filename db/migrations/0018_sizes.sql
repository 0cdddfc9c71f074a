-- Sizes of one pattern file had one key, so that each got the drape of whichever ran first. Which of them is right is not stored: none
-- stays current. Their studies run again.
INSERT INTO job_log (job_id, at, level, text)
SELECT job_id, coalesce(finished_at, queued_at), 'warn', 'superseded: it shared its result with another size of its pattern file; run its study again'
FROM job
WHERE is_current AND status IN ('done', 'not_converged')
    AND EXISTS (SELECT 1 FROM job AS other WHERE other.input_hash = job.input_hash AND other.size <> job.size);

UPDATE job SET is_current = 0
WHERE is_current AND status IN ('done', 'not_converged')
    AND EXISTS (SELECT 1 FROM job AS other WHERE other.input_hash = job.input_hash AND other.size <> job.size);
