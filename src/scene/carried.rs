//! The scenes that the program carries, so that `run @cone` needs no checkout: every file of scenes/.

/// Name and text, by name.
pub const CARRIED: &[(&str, &str)] = &[
    ("cone", include_str!("../../scenes/cone.toml")),
    ("cuboids", include_str!("../../scenes/cuboids.toml")),
    ("free_top", include_str!("../../scenes/free_top.toml")),
    ("heavy_top", include_str!("../../scenes/heavy_top.toml")),
    (
        "push_at_a_and_b",
        include_str!("../../scenes/push_at_a_and_b.toml"),
    ),
    ("spheres", include_str!("../../scenes/spheres.toml")),
    ("wheel", include_str!("../../scenes/wheel.toml")),
    ("wing_nut", include_str!("../../scenes/wing_nut.toml")),
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn every_scene_of_the_folder_is_carried() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
        let mut names: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter_map(|name| name.strip_suffix(".toml").map(str::to_owned))
            .collect();
        names.sort();
        let carried: Vec<&str> = CARRIED.iter().map(|(name, _)| *name).collect();
        assert_eq!(
            carried, names,
            "add the scene to CARRIED, in order of the names"
        );
    }
}
