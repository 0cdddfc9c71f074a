use super::*;
#[test]
fn dump() {
    let out = std::path::Path::new("/tmp/names/cmp/unit");
    std::fs::create_dir_all(out).unwrap();
    let list = std::fs::read_to_string("/tmp/names/list.txt").unwrap();
    for path in list.lines() {
        let bytes = std::fs::read(path).unwrap();
        let Ok(mut file) = crate::dxf::read(&bytes, path, None) else { continue };
        if file.unit_source == crate::dxf::UnitSource::Assumed {
            file = crate::dxf::read(&bytes, path, Some(crate::dxf::Unit::Mm)).unwrap();
        }
        let size = file.sample_size().to_owned();
        let Ok(pieces) = file.to_sew(Some(&size)) else { continue };
        let t = std::time::Instant::now();
        let proposal = propose(&pieces);
        eprintln!("{path}: {} pieces {:.2} s", pieces.len(), t.elapsed().as_secs_f64());
        let key = path
            .replace("/work/shared/", "")
            .replace("/tmp/names/astm/packages/astm-parser/test/data/dxf/", "astm/")
            .replace('/', "__");
        std::fs::write(out.join(key + ".json"), serde_json::to_string(&proposal).unwrap()).unwrap();
    }
}
