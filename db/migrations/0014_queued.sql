-- The next job is found without sorting all those that wait.
CREATE INDEX job_queued ON job (priority DESC, job_id) WHERE status = 'queued' AND is_current;
