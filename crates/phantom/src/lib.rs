//! Bodies of known shape as CT volumes and DICOM series.
