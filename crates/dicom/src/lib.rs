//! A folder of files to its CT series and their volumes.
